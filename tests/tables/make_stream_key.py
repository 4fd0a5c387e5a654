"""Keys of random streams from their definition, as stated in estimators/stream.h."""

import pathlib

WORD = 2**64 - 1


def finalise(z):
    z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9 & WORD
    z = (z ^ z >> 27) * 0x94D049BB133111EB & WORD
    return z ^ z >> 31


def words(text):
    data = text.encode()
    yield len(data)
    for i in range(0, len(data), 8):
        yield int.from_bytes(data[i:i + 8], "little")


def key(seed, plugin, parameters, copy):
    state = 0
    for word in [seed, *words(plugin), *words(parameters), copy]:
        state = finalise((state ^ word) + 0x9E3779B97F4A7C15 & WORD)
    return finalise(state)


ROWS = [(0, "", "", 0), (1, "luminaire/area", "scene=triangle", 0),
        (1, "luminaire/area", "scene=triangle", 1), (2**64 - 1, "12345678", "123456789", 2**32 - 1)]

with open(pathlib.Path(__file__).with_name("stream_key.csv"), "w") as out:
    out.write("# python3 tests/tables/make_stream_key.py\n")
    out.write("seed,plugin,parameters,copy,key\n")
    for row in ROWS:
        out.write(",".join(map(str, row + (key(*row),))) + "\n")
