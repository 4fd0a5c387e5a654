#include "harness/command/cli_help.h"

#include <algorithm>
#include <map>

namespace assay::harness {

std::string general_help() {
  return R"(Assay tests whether Monte Carlo estimators do what their authors claim.

Examples:
  assay run suites/luminaire.yaml
  assay check 'mean(luminaire/area) == analytic' --detect 0.5%
  assay describe luminaire/area

Commands (each has its own --help, with examples and defaults):
  run       test the claims of suite files
  plan      what a run would do and cost; only the pilots are drawn
  check     test one claim
  images    hold rendered pictures against each other, without a suite
  calibrate how often the methods err, and how much they find, on known laws
  sample    print observations of an estimator
  list      list plugins, tests of suites, methods, quantities, laws, gates, reports
  describe  print the manual of a plugin, a method, a quantity or a law
  replay    draw the numbers of a recorded test again
  merge     join the records of shards to that of one run
  report    make reports from a saved run
  help      this text, or that of a command: `assay help run`

Options:
  -h, --help   this text
  --version    version and commit

Exit codes:
  0    every test came out as expected
  1    at least one did not: it failed, was invalid or could not be tested; or the ledger alarms
  2    a mistake in what was asked for, or trouble
  3    none of these, but at least one is inconclusive
  4    no test ran: --filter, --tag or --shard selected none (0 where the environment asked for a shard)
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
  assay run suites/*.yaml --tag bias --filter '-*slope*'      tests with a tag, but for some
  assay run suites/luminaire.yaml --report json=run.json html=run.html
  assay run suites/luminaire.yaml --set triangle_area.scene=rectangle --seed 7
  assay run suites/luminaire.yaml --coarsen 4      a quick look: four times coarser effects
  assay run suites/luminaire.yaml --seed random --ledger nightly.ledger      every night
  assay run suites/luminaire.yaml --shard 2/4 --report json=2.json      a part, for `assay merge`
)"},
      {"plan",
       R"(Prints what a run of suites would do: of each test its method, sample sizes, expected cost and the
effect it finds. Runs the pilots only.

Examples:
  assay plan suites/luminaire.yaml
  assay plan suites/*.yaml --filter '*/variance*' --coarsen 4
)"},
      {"check", R"(Tests one claim. The names in it are plugins, or names given with --estimator.

Examples:
  assay check 'mean(luminaire/area) == analytic' --detect 0.5%
  assay check 'mean(luminaire/area) == 0.481046907316 +- 1e-12'
  assay check 'variance(a) < variance(h)' --estimator a=luminaire/area \
      --estimator 'h=luminaire/hemisphere,scene=rectangle'
)"},
      {"images",
       R"(Holds pictures of one scene against each other, pixel by pixel and on every larger scale: are their
means equal, and if not, where? Every file is one observation and needs a seed of its own.

Examples:
  assay images --candidate 'new/*.exr' --reference 'old/*.exr' --report html=difference.html
  assay images --candidate 'new/*.exr' --reference converged.exr --detect 1%
  assay images --candidate 'new/*.exr' --reference 'old/*.exr' --channels 'ViewLayer.DiffInd.*'
  assay images --candidate 'half/*.exr' --reference 'float/*.exr' --within 0.5% --report json=run.json
)"},
      {"calibrate",
       R"(Measures how often each method errs on laws whose truth is known, and how often it finds an effect:
the whole procedure with its pilot, gates and looks, and beside it the method alone. Exit code 1
where a cell errs too often.

Examples:
  assay calibrate
  assay calibrate F chi-square --law exponential --alpha 0.01 --runs 20000 --report html=F.html
  assay calibrate t --law 'lognormal(0, 2)' --samples 200
)"},
      {"sample", R"(Prints observations of an estimator or a sampler as text that `recorded` reads.

Examples:
  assay sample luminaire/area --secondaries 1000 > area.txt
  assay sample a --estimator 'a=luminaire/area,scene=rectangle' --primaries 64
)"},
      {"list",
       R"(Prints what there is: plugins and tests one id a line, the tables with a word on each row.

Examples:
  assay list plugins
  assay list tests suites/*.yaml
  assay list methods
)"},
      {"describe",
       R"(Prints the manual of a plugin: parameters, channels, references, samplers, mutants. Of a method, a
quantity, a law or a report it prints what the tables say.

Examples:
  assay describe luminaire/area
  assay describe t
)"},
      {"replay", R"(Draws the numbers of a recorded test again, or one observation of it alone.

Examples:
  assay replay run.json 'luminaire/mean(triangle_area) == analytic'
  assay replay run.json 'luminaire/mean(triangle_area) == analytic' 17
)"},
      {"merge",
       R"(Joins the records of all shards of a run, in any order, to the record of the whole, with Holm's
adjustment over each suite, and reports it. Nothing is sampled.

Examples:
  assay run suites/luminaire.yaml --shard 1/2 --report json=1.json
  assay run suites/luminaire.yaml --shard 2/2 --report json=2.json
  assay merge 1.json 2.json --report json=run.json html=run.html
)"},
      {"report", R"(Makes reports from a saved run; nothing is sampled.

Examples:
  assay report run.json --report html=run.html
  assay report run.json --report console=-
)"}};
  return texts.at(subcommand);
}

std::string wrapped_options(const std::string& help) {
  constexpr std::size_t width = 100;
  constexpr std::size_t indent = 30;  // column of CLI11's descriptions of options
  const std::size_t options = help.find("\nOptions:\n");
  if (options == std::string::npos) return help;
  std::string out = help.substr(0, options);
  std::string rest = help.substr(options);
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::size_t blank = rest.substr(0, width + 1).rfind(' ');
    if (end <= width || blank < indent || blank == std::string::npos) {
      out += rest.substr(0, end + 1);
      rest.erase(0, end + 1);
    } else {
      out += rest.substr(0, blank) + "\n";
      rest.replace(0, blank + 1, std::string(indent, ' '));
    }
  }
  return out;
}

}  // namespace assay::harness
