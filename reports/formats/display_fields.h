#pragma once

// The keys of `display` in the JSON record. Not part of the public interface.

#include "reports/words/display.h"

namespace assay::reports {

template <class Archive>
void fields(Archive& a, const Fact& fact) {
  a("label", fact.first);
  a("text", fact.second);
}

template <class Archive>
void fields(Archive& a, const TestDisplay& words) {
  a("standing", words.standing);
  a("verdict", words.verdict);
  a("sentence", words.sentence);
  a("effect", words.effect);
  a("interval", words.interval);
  a("margin", words.margin);
  a("chance", words.chance);
  a("place", words.place);
  a("cost", words.cost);
  a("facts", words.facts);
}

template <class Archive>
void fields(Archive& a, const KillCellDisplay& cell) {
  a("test", cell.test);
  a("text", cell.text);
  a("sentence", cell.sentence);
  a("killed", cell.killed);
}

template <class Archive>
void fields(Archive& a, const KillRowDisplay& row) {
  a("mutant", row.mutant);
  a("defect", row.defect);
  a("cells", row.cells);
}

template <class Archive>
void fields(Archive& a, const KillDisplay& kills) {
  a("methods", kills.methods);
  a("rows", kills.rows);
  a("totals", kills.totals);
  a("legend", kills.legend);
}

template <class Archive>
void fields(Archive& a, const StatementDisplay& words) {
  a("answer", words.answer);
  a("holds", words.holds);
  a("fails", words.fails);
}

template <class Archive>
void fields(Archive& a, const SuiteDisplay& words) {
  a("levels", words.levels);
  a("kills", words.kills);
  a("statements", words.statements);
}

template <class Archive>
void fields(Archive& a, const Suspect& suspect) {
  a("suite", suspect.suite);
  a("name", suspect.name);
  a("tests", suspect.tests);
  a("sentence", suspect.sentence);
}

template <class Archive>
void fields(Archive& a, const SeriesDisplay& words) {
  a("name", words.name);
  a("sentence", words.sentence);
  a("alarm", words.alarm);
}

template <class Archive>
void fields(Archive& a, const RecordDisplay& words) {
  a("verdict", words.verdict);
  a("counts", words.counts);
  a("rates", words.rates);
  a("seed", words.seed);
  a("suspects", words.suspects);
  a("ledger", words.ledger);
  a("quiet", words.quiet);
  a("notes", words.notes);
  a("series", words.series);
}

}  // namespace assay::reports
