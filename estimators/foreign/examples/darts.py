"""The area of the unit disc by darts, as an estimator for Assay's plugin `process`."""
import random
import struct

questions, replies = open(0, "rb"), open(1, "wb")  # buffered, where sys.stdout need not be
replies.write(b"assay 1 binary\nchannel area low 0 high 4\naverages\nbias unbiased\nready\n")
replies.flush()
while question := questions.read(32):
    key, first, count, primaries = struct.unpack("<4Q", question)
    for index in range(first, first + count):
        draw = random.Random(key << 64 | index).random  # a function of key and index alone
        hits = 0
        for _ in range(primaries):
            if (2 * draw() - 1) ** 2 + (2 * draw() - 1) ** 2 < 1:
                hits += 1
        replies.write(struct.pack("<d", 4 * hits / primaries))
    replies.write(question)
    replies.flush()
