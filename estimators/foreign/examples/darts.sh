#!/bin/sh
# The area of the unit disc by darts, as an estimator for Assay's plugin `process`.
uniform() { # u, one of 0 to 2^31 - 1, by SplitMix64 (Steele, Lea and Flood 2014)
  state=$((state - 7046029254386353131))
  z=$(((state ^ (state >> 30 & 0x3ffffffff)) * -4658895280553007687))
  z=$(((z ^ (z >> 27 & 0x1fffffffff)) * -7723592293110705685))
  u=$(((z ^ (z >> 31 & 0x1ffffffff)) >> 33 & 0x7fffffff))
}
printf 'assay 1 text\nchannel area low 0 high 4\naverages\nbias unbiased\nready\n'
while read -r high low first count primaries; do
  i=$first
  while [ "$i" -lt $((first + count)) ]; do
    state=$i && uniform # a function of key and index alone
    state=$(((high << 32 | low) ^ z)) hits=0 n=0
    while [ "$n" -lt "$primaries" ]; do
      uniform && x=$u && uniform
      hits=$((hits + (x * x + u * u < 1 << 62))) n=$((n + 1))
    done
    printf '%d.%09d\n' $((4 * hits / primaries)) $((4 * hits % primaries * 1000000000 / primaries))
    i=$((i + 1))
  done
  echo "$high $low $first $count $primaries"
done
