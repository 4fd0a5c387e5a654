#!/usr/bin/env bash
# Builds the tests of stats/ and of random streams for arm64, runs them under QEMU, and lists the results
# whose bits differ from this machine's (tests/estimators/arm64_bits.cpp). The functions of the C library
# may differ, and what needs them. Ends with exit code 1 if a test fails or anything else differs.
#   bash tests/arm64.sh
set -euo pipefail
cd "$(dirname "$0")/.."
source suites/install.sh

install_packages suites/packages.txt tests/packages.txt \
  <(printf '%s\n' g++-aarch64-linux-gnu qemu-user)

# The libraries of arm64 are unpacked, not installed: some cannot stand beside those of this machine.
root=$PWD/build/arm64/root
libraries=$(grep -h -- '-dev$' suites/packages.txt tests/packages.txt | sort)
if [ "$(cat "$root/libraries" 2>/dev/null)" != "$libraries" ]; then
  rm -rf "$root"
  mkdir -p "$root"/apt/lists/partial "$root"/apt/archives/partial
  touch "$root/apt/status"
  from_arm64=(apt-get -qq -o APT::Architecture=arm64 -o APT::Architectures=arm64
    -o Dir::State="$root/apt" -o Dir::State::status="$root/apt/status"
    -o Dir::Cache="$root/apt" -o Debug::NoLocking=1)
  "${from_arm64[@]}" update >&2
  # shellcheck disable=SC2086  # one word a package
  "${from_arm64[@]}" install -y --no-install-recommends --download-only $libraries >&2
  rm -f "$root"/apt/archives/libc6-dev_*  # the cross compiler has its own
  for package in "$root"/apt/archives/*.deb; do dpkg -x "$package" "$root"; done
  echo "$libraries" >"$root/libraries"
fi

build_project build/arm64 stats_test streams_test arm64_bits -- -DASSAY_TESTS=ON \
  -DCMAKE_SYSTEM_NAME=Linux -DCMAKE_SYSTEM_PROCESSOR=aarch64 \
  -DCMAKE_CXX_COMPILER=aarch64-linux-gnu-g++ -DCMAKE_FIND_ROOT_PATH="$root" \
  -DCMAKE_FIND_ROOT_PATH_MODE_{LIBRARY,INCLUDE,PACKAGE}=ONLY \
  -DCMAKE_EXE_LINKER_FLAGS="-Wl,-rpath-link,$root/usr/lib/aarch64-linux-gnu:$root/lib/aarch64-linux-gnu" \
  "-DCMAKE_CROSSCOMPILING_EMULATOR=qemu-aarch64;-L;$root"
build_project build arm64_bits -- -DASSAY_TESTS=ON

code=0
for folder in stats estimators; do
  ctest --test-dir "build/arm64/tests/$folder" --output-on-failure --no-tests=error -j "$(nproc)" \
    --label-exclude '^long$' --exclude-regex '_NOT_BUILT' || code=1
done

bits=tests/estimators/arm64_bits
here=$("build/$bits")
there=$(qemu-aarch64 -L "$root" "build/arm64/$bits")
differing=$(grep -vxF -- "$here" <<<"$there") || true
echo "other bits on arm64: ${differing:-none}"
if grep -E '^(stream|libm sqrt|moments|denormals) ' <<<"$differing"; then
  echo "these need no function of the C library" >&2
  code=1
fi
exit $code
