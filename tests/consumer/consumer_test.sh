#!/usr/bin/env bash
# Installs the build, then builds and tests a project that finds the package.
#   consumer_test.sh BUILD_FOLDER SOURCE_FOLDER
set -uo pipefail

build=$1
source_folder=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() {
  printf 'FAILED: %s\n' "$*"
  tail -n 60 "$work/log"
  exit 1
}
contains() { grep -qF -- "$1" "$work/log" || fail "no \`$1\`"; }
run() { "$@" >"$work/log" 2>&1; }

run cmake --install "$build" --prefix "$work/first" || fail 'the installation failed'
# The package is found where the prefix is now, not where it was made.
mv "$work/first" "$work/prefix"
[ -z "$(grep -rlF "$work/first" "$work/prefix/lib")" ] || fail 'a path of the installation is fixed'
for file in man/man1/assay.1 bash-completion/completions/assay zsh/site-functions/_assay \
            fish/vendor_completions.d/assay.fish assay/python/pyproject.toml; do
  [ -s "$work/prefix/share/$file" ] || fail "share/$file is not installed"
done
cp -r "$source_folder/tests/consumer" "$work/project"
cp "$source_folder/estimators/foreign/examples/darts_library.c" "$work/project"
cd "$work/project" || exit 1
sed -n '/^```cpp$/,/^```$/{/^```/!p}' "$source_folder/README.md" >readme_test.cpp

run cmake -S . -B build -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$work/prefix" || fail 'the project is not configured'
run cmake --build build || fail 'the project is not built'
run ctest --test-dir build || true
contains 'claims/mean(normal) == 2 '
contains "claims/a name; with [brackets, 'quotes' \"and\" \$signs "
contains 'again:claims/mean(normal) == 2 '
# The second set-up makes the mean 3.
contains 'darts/mean(darts) == 3.141592653589793 '
contains '80% tests passed, 1 tests failed out of 5'
run build/readme_test || fail 'the example of README.md fails'

# 50 true claims at alpha 0.01 together, coarse, since a run takes a second. By chance 3 of 4 seeds
# fail with probability 4e-6, and 5 of 30 with 1.2e-5 (binomial at .01).
if [ -n "${ASSAY_LONG:-}" ]; then seeds=30 most=4; else seeds=4 most=2; fi
failures=0
for seed in $(seq 1 $seeds); do
  ASSAY_SEED=$seed run build/claims_test --gtest_output="xml:$work/claims.xml" || failures=$((failures + 1))
done
[ "$failures" -le $most ] || fail "$failures of $seeds runs of true claims fail"
echo "$failures of $seeds runs of 50 true claims at alpha 0.01 failed"
grep -q 'property name="estimate_25" value=' "$work/claims.xml" || fail 'no properties'

# A claim that is new, and one that is misspelt, need no build.
printf '  - {name: new, claim: mean(normal) <= 9}\n' >>claims.yaml
run ctest --test-dir build -R '^claims/new$' || fail 'the new claim fails'
contains '100% tests passed, 0 tests failed out of 1'
printf '  - {claim: maen(normal) <= 9}\n' >>claims.yaml
! run ctest --test-dir build --output-on-failure || fail 'a suite that cannot be read passes'
contains 'did you mean `mean`'

sed -i 's/assay 0.1/assay 99/' CMakeLists.txt
! run cmake -S . -B newer -DCMAKE_PREFIX_PATH="$work/prefix" || fail 'version 99 is found'
contains '"99"'
