#!/usr/bin/env bash
# `assay init` writes examples that run. TEST is one of the functions test_… below.
#   init_test.sh ASSAY SOURCE_FOLDER TEST
set -uo pipefail

source "$(dirname "$0")/program.sh"
# A user has the program's folder on the PATH. CMake finds the package beside it.
export PATH="$(dirname "$assay")/../prefix/bin:$PATH"

# runs_at_once TESTS KIND…: writes the example into an empty folder and runs what is printed.
runs_at_once() {
  local tests=$1 start code=0
  shift
  expect 0 init "$@" 'a folder'
  sed -n 's/^    //p' out >commands
  [ -s commands ] || fail 'no command is printed'
  start=$SECONDS
  bash -e commands >out 2>err </dev/null || code=$?
  [ $code -eq 0 ] || fail "the printed commands of $* ended with $code"
  contains out "$tests"
  # The machine may be busy: 10 s are meant, 60 s are a defect.
  [ $((SECONDS - start)) -lt 60 ] || fail "the example took $((SECONDS - start)) s"
}

test_init_suite_runs_at_once() { runs_at_once 'All 2 claims are as they should be' suite; }
test_init_plugin_runs_at_once() {
  runs_at_once 'All 3 claims are as they should be' plugin
  ctest --test-dir 'a folder/build' >out 2>err || fail 'ctest fails'
  contains out '100% tests passed, 0 tests failed out of 3'
}
test_init_process_python_runs_at_once() { runs_at_once 'All 3 claims are as they should be' process python; }
test_init_process_cpp_runs_at_once() { runs_at_once 'All 3 claims are as they should be' process c++; }
test_init_gtest_runs_at_once() { runs_at_once '3 tests' gtest; }
# GoogleTest asks a matcher that failed a second time, for its reason: that is no second claim.
test_init_gtest_builds_matchers() {
  expect 0 init gtest mine
  printf '%s\n' '#include <assay/harness/googletest/matchers.h>' 'using namespace assay::googletest;' \
    'const DeclaredClaims budget{{.claims = 1}};' \
    'double draw(assay::Stream& random) { return random.uniform(); }' \
    'TEST(Draw, IsBiased) { EXPECT_THAT(draw, HasMean("1")); }' >mine/claims_test.cpp
  { cmake -S mine -B build && cmake --build build; } >out 2>err || fail 'the matchers are not built'
  build/claims_test >out 2>err && fail 'a wrong claim holds'
  contains out 'fail: relative difference from the reference'
}
test_init_gtest_says_how_to_build_its_library() {
  expect 0 init gtest mine
  cp -rL "$(dirname "$assay")/../prefix/lib" lib
  sed -i 's|".*/libassay_googletest.a"|"/no/such.a"|' lib/cmake/assay/assayTargets.cmake
  cmake -S mine -B build -D CMAKE_PREFIX_PATH="$PWD" >out 2>err && fail 'a library that is not there is found'
  contains err "run in Assay's own folder: cmake build && cmake --build build"
}
test_init_github_runs_at_once() {
  runs_at_once 'All 2 claims are as they should be' github
  is_a_job 'a folder/.github/workflows/assay.yml'
  contains 'a folder/.github/workflows/assay.yml' '#     cmake -S . -B build'
}
test_init_gitlab_runs_at_once() {
  runs_at_once 'All 2 claims are as they should be' gitlab
  is_a_job 'a folder/.gitlab-ci.yml'
  contains 'a folder/.gitlab-ci.yml' '# - cmake -S . -B build'
}

# Each script of the job is a shell's, and the reports that it makes are there.
is_a_job() {
  /usr/bin/python3 - "$1" <<'PYTHON' >scripts || fail 'no job of CI'
import sys, yaml
job = yaml.safe_load(open(sys.argv[1]))
steps = job["jobs"]["claims"]["steps"] if "jobs" in job else [{"run": s} for s in job["claims"]["script"]]
print("\n".join(step["run"] for step in steps if "run" in step))
PYTHON
  bash -n scripts 2>err || fail 'a script that no shell reads'
  lacks scripts '@'
  contains scripts 'assay run claims/*.yaml --report junit=junit.xml html=report.html'
  [ -s 'a folder/junit.xml' ] && [ -s 'a folder/report.html' ] || fail 'no reports'
}

# A file of the user is named, and all files stay as they are.
test_init_never_overwrites() {
  local kind
  while read -r kind file; do
    mkdir -p "$kind/$(dirname "$file")"
    echo mine >"$kind/$file"
    # shellcheck disable=SC2086  # a kind may have two words
    expect 2 init ${kind//-/ } "$kind"
    empty out
    contains err "\`$kind/$file\` exists already, so nothing is written"
    [ "$(cat "$kind/$file")" = mine ] || fail "$kind/$file is overwritten"
    [ "$(find "$kind" -type f | wc -l)" = 1 ] || fail "files beside $kind/$file"
  done <<'FILES'
suite mine.yaml
plugin mine.yaml
process-python mine.yaml
process-c++ mine.cpp
gtest claims_test.cpp
github claims/mine.yaml
gitlab .gitlab-ci.yml
FILES
}

test_init_names_its_kinds() {
  expect 2 init
  contains err '`assay init` needs one of github, gitlab, gtest, plugin, process c++, process python, suite'
  expect 2 init siute
  contains err 'did you mean `suite`?'
  expect 2 init process
  contains err 'process python'
  expect 2 init suite /dev/null/x
  contains err 'cannot write into `/dev/null/x`: Not a directory; name another folder'
  expect 2 init suite here there
  contains err '`there` is one argument too many'
  [ "$(ls)" = $'err\nout' ] || fail 'a file is written'
}

"$3"
