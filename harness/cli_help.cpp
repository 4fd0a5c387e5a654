#include "harness/cli_help.h"

#include <map>

namespace assay::harness {

std::string general_help() {
  return R"(Assay tests whether Monte Carlo estimators do what their authors claim.

Examples:
  assay run suites/luminaire.yaml
  assay check 'mean(luminaire/area) == analytic' --detect 0.5%
  assay describe luminaire/area

Commands (each has its own --help):
  run       test the claims of suite files
  check     test one claim
  sample    print observations of an estimator
  list      list plugins, or the tests of suites
  describe  print the manual of a plugin
  replay    draw the numbers of a recorded test again
  report    make reports from a saved run

Options:
  -h, --help   this text
  --version    version and commit

Exit codes:
  0    every test came out as expected
  1    at least one did not
  2    a mistake in what was asked for, or trouble
  3    none failed, but at least one could not be decided
  4    no test ran
  77   all tests were skipped
  130  interrupted
)";
}

std::string help_of(const std::string& subcommand) {
  static const std::map<std::string, std::string> texts{
      {"run", R"(Tests the claims of suite files.

Examples:
  assay run suites/luminaire.yaml
  assay run suites/*.yaml --filter '*/variance*' --threads 4
  assay run suites/luminaire.yaml --report json=run.json --report html=run.html
  assay run suites/luminaire.yaml --set area.scene=rectangle --seed 7
  assay run suites/luminaire.yaml --coarsen 4      a quick look: four times coarser effects
)"},
      {"check", R"(Tests one claim. The names in it are plugins, or names given with --estimator.

Examples:
  assay check 'mean(luminaire/area) == analytic' --detect 0.5%
  assay check 'mean(luminaire/area) == 0.481046907316 +- 1e-12'
  assay check 'variance(a) < variance(h)' --estimator a=luminaire/area \
      --estimator 'h=luminaire/hemisphere,scene=rectangle'
)"},
      {"sample", R"(Prints observations of an estimator or a sampler as text that `recorded` reads.

Examples:
  assay sample luminaire/area --secondaries 1000 > area.txt
  assay sample a --estimator 'a=luminaire/area,scene=rectangle' --primaries 64
)"},
      {"list", R"(Prints one id a line: the plugins there are, or the tests of suites.

Examples:
  assay list plugins
  assay list tests suites/*.yaml
)"},
      {"describe",
       R"(Prints the manual of a plugin: parameters, channels, references, samplers, mutants.

Examples:
  assay describe luminaire/area
)"},
      {"replay", R"(Draws the numbers of a recorded test again, or one observation of it alone.

Examples:
  assay replay run.json 'luminaire/mean(area) == analytic'
  assay replay run.json 'luminaire/mean(area) == analytic' 17
)"},
      {"report", R"(Makes reports from a saved run; nothing is sampled.

Examples:
  assay report run.json --report html=run.html
  assay report run.json --report console=-
)"}};
  return texts.at(subcommand);
}

}  // namespace assay::harness
