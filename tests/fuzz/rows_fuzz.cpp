// Rows of other programs: text and numpy's arrays, both also packed (estimators/recorded/table.h).
// All bytes are read, or refused with the file's name and a place in it. A table that was read is
// whole.

#include "estimators/core/value.h"
#include "estimators/recorded/table.h"
#include "tests/fuzz/case.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using assay::fuzz::require;
  const std::string file = assay::fuzz::written(data, size, ".txt");
  try {
    const assay::recorded::Table table =
        assay::recorded::read_table(file, assay::recorded::Rows::several);
    require(table.rows() > 0);
    require(table.values.size() == table.rows() * table.columns.size());
    require(table.lines.empty() || table.lines.size() == table.rows());
    for (const std::string& name : table.columns) require(!name.empty());
    require(table.digest() ==
            assay::recorded::read_table(file, assay::recorded::Rows::several).digest());
  } catch (const assay::InputError& error) {
    require(error.where().file == file);
    require(!error.message().empty() && error.message().size() < 1000);
    require(error.where().line == 0 || error.where().column > 0);
  }
  return 0;
}
