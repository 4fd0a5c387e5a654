"""Philox4x32-10 from its definition (Salmon et al. 2011, section 3.3), to check the streams against.

Rows: the counter's four words, the key's two, and the four words that come out.
"""

import pathlib

WORD = 0xFFFFFFFF


def philox(counter, key):
    c, k = list(counter), list(key)
    for _ in range(10):
        low, high = 0xD2511F53 * c[0], 0xCD9E8D57 * c[2]
        c = [high >> 32 ^ c[1] ^ k[0], high & WORD, low >> 32 ^ c[3] ^ k[1], low & WORD]
        k = [k[0] + 0x9E3779B9 & WORD, k[1] + 0xBB67AE85 & WORD]
    return c


def rows():
    yield [0] * 4, [0] * 2
    yield [WORD] * 4, [WORD] * 2
    # Digits of pi, as in the known answers of the Random123 distribution.
    yield [0x243F6A88, 0x85A308D3, 0x13198A2E, 0x03707344], [0xA4093822, 0x299F31D0]
    key = [0x89ABCDEF, 0x01234567]
    for observation in (0, 1, 0x123456789A):
        for substream in (0, 1, 8):
            for draw in (0, 1):
                low, high = observation & WORD, observation >> 32
                yield [draw, substream, low, high], key


with open(pathlib.Path(__file__).with_name("philox.csv"), "w") as out:
    out.write("# python3 tests/tables/make_philox.py\n")
    out.write("c0,c1,c2,c3,k0,k1,r0,r1,r2,r3\n")
    for counter, key in rows():
        out.write(",".join(str(w) for w in counter + key + philox(counter, key)) + "\n")
