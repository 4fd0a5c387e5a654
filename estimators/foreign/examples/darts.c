/* The area of the unit disc by darts, as an estimator for Assay's plugin `process`. */
#include <stdint.h>
#include <stdio.h>
static uint64_t word(uint64_t *state) { /* SplitMix64 (Steele, Lea and Flood 2014) */
  uint64_t z = (*state += 0x9e3779b97f4a7c15u);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}
static int hit(uint64_t *state) {
  double u = (double)(word(state) >> 11) * 0x1p-53, v = (double)(word(state) >> 11) * 0x1p-53;
  return u * u + v * v < 1;
}
int main(void) {
  uint64_t question[4]; /* key, first, count, primaries */
  puts("assay 1 binary\nchannel area low 0 high 4\naverages\nbias unbiased\nready");
  for (; !fflush(stdout) && fread(question, 8, 4, stdin) == 4; fwrite(question, 8, 4, stdout)) {
    for (uint64_t i = question[1]; i < question[1] + question[2]; ++i) {
      uint64_t index = i, state = question[0] ^ word(&index), hits = 0; /* of key and index alone */
      for (uint64_t n = 0; n < question[3]; ++n) hits += (uint64_t)hit(&state);
      fwrite(&(double){4 * (double)hits / (double)question[3]}, 8, 1, stdout);
    }
  }
}
