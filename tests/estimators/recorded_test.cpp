#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include "estimators/core/line_error.h"
#include "estimators/core/waiting.h"
#include "estimators/ready_made.h"
#include "recorded/byte_source.h"
#include "recorded/table.h"
#include "tests/estimators/draws.h"
#include "tests/prelude.h"

namespace assay {
namespace {

/// As gzip does it.
std::string packed(const std::string& text) {
  z_stream stream = {};
  deflateInit2(&stream, 6, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY);
  std::string out(deflateBound(&stream, text.size()) + 64, '\0');
  std::string in = text;
  stream.next_in = reinterpret_cast<Bytef*>(in.data());
  stream.avail_in = static_cast<uInt>(in.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

class Recorded : public InFolder {
 protected:
  std::string write(const std::string& text) const { return place_.write("data.txt", text); }
  recorded::Table read(const std::string& text) const {
    return recorded::read_table(write(text), recorded::Rows::several);
  }

  struct Refusal {
    int line;
    int column;
    std::string message;
  };
  Refusal refusal(const std::string& text) const {
    try {
      read(text);
    } catch (const InputError& error) {
      EXPECT_EQ(error.where().file, (folder_ / "data.txt").string());
      return {error.where().line, error.where().column, error.message()};
    }
    return {-1, -1, "nothing was refused"};
  }
  void expect_refused(const std::string& text, std::pair<int, int> place,
                      const std::string& message) const {
    const Refusal r = refusal(text);
    EXPECT_EQ(std::pair(r.line, r.column), place) << r.message;
    EXPECT_THAT(r.message, HasSubstr(message));
  }

  draws::Prepared prepare(const std::string& text, const std::string& more = "") const {
    write(text);
    return draws::prepare("recorded", "{file: data.txt" + more + "}", folder_.string());
  }
  std::string said_of(const std::string& name) const {
    return thrown<InputError>([&] { recorded::read_table(name, recorded::Rows::several); });
  }
  /// Why a plugin's file is refused.
  std::string said_of_file(const std::string& name) const {
    return thrown<InputError>(
        [&] { draws::prepare("recorded", "{file: " + name + "}", folder_.string()); });
  }
};

TEST_F(Recorded, ReadsColumnsByWhiteSpaceOrCommas) {
  const auto table = read("# columns: a b\n1 2.5\n-3e-2,\t4 # note\n\n  +5   6\r\n");
  EXPECT_THAT(table.columns, ElementsAre("a", "b"));
  EXPECT_THAT(table.values, ElementsAre(1, 2.5, -0.03, 4, 5, 6));
  EXPECT_EQ(table.rows(), 3u);
}

TEST_F(Recorded, KnowsWhereEachRowStands) {
  const draws::Prepared rows = prepare("# columns: a\n1\n\n2 # note\n# more\nnan\n");
  const std::string file = std::filesystem::weakly_canonical(folder_ / "data.txt").string();
  EXPECT_EQ(recorded::observation_place(*rows.setup, {.index = 0}), file + ":2");
  EXPECT_EQ(recorded::observation_place(*rows.setup, {.index = 1}), file + ":4");
  EXPECT_EQ(recorded::observation_place(*rows.setup, {.index = 2}), file + ":6");
  EXPECT_EQ(recorded::observation_place(*rows.setup, {.index = 3}), "");
}

TEST_F(Recorded, NamesColumnsThatHaveNone) {
  EXPECT_THAT(read("1\n2").columns, ElementsAre("value"));
  EXPECT_THAT(read("# made by hand\n1 2 3\n4 5 6\n").columns,
              ElementsAre("value1", "value2", "value3"));
  EXPECT_THAT(read("\xef\xbb\xbf# columns: x, y\n1,2\n").columns, ElementsAre("x", "y"));
}

TEST_F(Recorded, KeepsValuesThatAreNotFinite) {
  const auto table = read("1 inf\n-inf nan\n");
  EXPECT_EQ(table.values[1], std::numeric_limits<double>::infinity());
  EXPECT_EQ(table.values[2], -std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(table.values[3]));
}

TEST_F(Recorded, KeepsEveryBitOfANumber) {
  EXPECT_EQ(read("0.1\n").values[0], 0.1);
  EXPECT_EQ(read("1.7976931348623157e308\n").values[0], std::numeric_limits<double>::max());
  EXPECT_EQ(read("4.9406564584124654e-324\n").values[0], std::numeric_limits<double>::denorm_min());
}

TEST_F(Recorded, RefusesJunk) {
  expect_refused("1\n2\nthree\n", {3, 1}, "`three` is not a number");
  expect_refused("1 2x\n", {1, 3}, "`2x` is not a number");
  expect_refused("1,2\na,b\n", {2, 1}, "# columns: a b");
  expect_refused("a,2\n", {1, 1}, "`a` is not a number");
  expect_refused("1,2 3\n", {1, 3}, "`2 3` is not a number");
  expect_refused("1.#INF\n", {1, 1}, "`1.#INF` is not a number");
  // A number that is missing is no name.
  expect_refused("NA\n1\n", {1, 1}, "`NA` is not a number; write `nan`");
  expect_refused("+-1\n", {1, 1}, "`+-1` is not a number");
  expect_refused("0x10\n", {1, 1}, "is not a number");
}

TEST_F(Recorded, RefusesWhatNoDoubleCanHold) {
  expect_refused("1\n 1e999\n", {2, 2}, "beyond what a double can hold");
}

TEST_F(Recorded, RefusesAnEmptyField) {
  expect_refused("1,,3\n", {1, 3}, "a number is missing");
  expect_refused("1,\n", {1, 3}, "a number is missing");
}

TEST_F(Recorded, RefusesRaggedRows) {
  expect_refused("1 2\n3\n", {2, 1}, "numbers in this row: 1, but columns: 2");
  expect_refused("1 2\n3 4 5\n", {2, 5}, "numbers in this row: 3, but columns: 2");
  expect_refused("# columns: a\n1 2\n", {2, 3}, "numbers in this row: 2, but columns: 1");
}

TEST_F(Recorded, RefusesBadHeaders) {
  expect_refused("# columns: a a\n1 2\n", {1, 14}, "two columns `a`");
  expect_refused("# columns: a,,b\n1 2\n", {1, 14}, "the name of a column is empty");
  expect_refused("# columns:\n1\n", {1, 3}, "names no column");
  expect_refused("1\n# columns: a\n", {2, 3}, "before the first row");
  expect_refused("# columns: a\n# columns: b\n1\n", {2, 3}, "must stand once");
}

TEST_F(Recorded, RefusesAFileWithoutRows) {
  expect_refused("", {0, 0}, "it is empty");
  expect_refused("a,b\n", {0, 0}, "no rows");
  expect_refused("# columns: a\n\n", {0, 0}, "no rows");
}

TEST_F(Recorded, RefusesAFileThatIsNotThereAndAFolder) {
  EXPECT_NE(said_of(file("none.txt")), thrown([] {}));
  EXPECT_THAT(said_of_file("none.txt"),
              AllOf(HasSubstr("none.txt"), HasSubstr("cannot be read: No such file or directory")));
  EXPECT_THAT(said_of_file("."), HasSubstr("cannot be read: it is a folder"));
}

TEST_F(Recorded, ObservationIsTheRow) {
  const auto plugin = prepare("# columns: a b\n1 2\n3 4\n5 6\n");
  EXPECT_EQ(plugin.setup->observations(), 3u);
  EXPECT_FALSE(plugin.information.averages);
  const auto channels = plugin.setup->channels();
  ASSERT_EQ(channels.size(), 2u);
  EXPECT_EQ(channels[0].name, "a");
  EXPECT_FALSE(channels[0].mean.has_value());
  const auto samples = draws::observe(plugin, 3);
  EXPECT_THAT(samples[0].values, ElementsAre(1, 3, 5));
  EXPECT_THAT(samples[1].values, ElementsAre(2, 4, 6));
}

TEST_F(Recorded, PicksOneColumn) {
  const auto plugin = prepare("# columns: a b\n1 2\n3 4\n", ", column: b");
  ASSERT_EQ(plugin.setup->channels().size(), 1u);
  EXPECT_EQ(plugin.setup->channels()[0].name, "b");
  EXPECT_THAT(draws::observe(plugin, 2)[0].values, ElementsAre(2, 4));
}

TEST_F(Recorded, RefusesAColumnThatIsNotThere) {
  EXPECT_THAT(
      thrown<InputError>([&] { prepare("# columns: a b\n1 2\n", ", column: c"); }),
      HasSubstr(
          "parameter `column` must be a column of the file, but it is `c`; there is: `a`, `b`"));
}

TEST_F(Recorded, RefusesMoreThanItHas) {
  const auto plugin = prepare("1\n2\n");
  EXPECT_THROW(draws::observe(plugin, 3), std::out_of_range);
  EXPECT_THROW(draws::observe(plugin, 1, 2), std::invalid_argument);
}

TEST_F(Recorded, TakesNamesFromAFirstLineWithoutNumbers) {
  const auto csv = read("x,y\n1,2\n3,4\n");
  EXPECT_THAT(csv.columns, ElementsAre("x", "y"));
  EXPECT_THAT(csv.values, ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(csv.lines, ElementsAre(2, 3));
  EXPECT_THAT(read("\xef\xbb\xbf\"x, mean\",\"the \"\"y\"\"\"\r\n\"1\",2\r\n").columns,
              ElementsAre("x, mean", "the \"y\""));
  EXPECT_THAT(read("x y\n1 2\n").columns, ElementsAre("x", "y"));
  EXPECT_THAT(read("value\n0.5\n").values, ElementsAre(0.5));
  EXPECT_THAT(read("# of a run\n\nvalue # in W\n0.5\n").columns, ElementsAre("value"));
  expect_refused("x,x\n1,2\n", {1, 3}, "two columns `x`");
  expect_refused("x,y\n1,2,3\n", {2, 5}, "columns: 2 (named in line 1)");
}

// pandas.DataFrame({'a': [1, 3], 'b': [2, 4]}).to_csv() and R's write.csv().
TEST_F(Recorded, LeavesOutTheNamesOfRows) {
  for (const char* text : {",a,b\n0,1,2\n1,3,4\n", "\"\",\"a\",\"b\"\n\"r1\",1,2\n\"r2\",3,4\n"}) {
    const auto table = read(text);
    EXPECT_THAT(table.columns, ElementsAre("a", "b"));
    EXPECT_THAT(table.values, ElementsAre(1, 2, 3, 4));
  }
}

TEST_F(Recorded, SplitsAtSemicolonsAndTabs) {
  const auto german = read("\"x\";\"y\"\n1,5;-2,25e1\n3;4.5\n");
  EXPECT_THAT(german.columns, ElementsAre("x", "y"));
  EXPECT_THAT(german.values, ElementsAre(1.5, -22.5, 3, 4.5));
  const auto tabs = read("x pos\ty pos\n1\t2\n3\t4\t\n");
  EXPECT_THAT(tabs.columns, ElementsAre("x pos", "y pos"));
  EXPECT_THAT(tabs.values, ElementsAre(1, 2, 3, 4));
  expect_refused("1\t\t3\n", {1, 3}, "a number is missing");
  expect_refused("1;;3\n", {1, 3}, "a number is missing");
  expect_refused("1.234,5;2\n", {1, 1}, "`1.234,5` is not a number");
  expect_refused("x\n1,5\n", {2, 3}, "write decimal points for commas");
}

TEST_F(Recorded, AsksOfOneRowWhetherItsNumbersAreObservations) {
  std::string row;
  for (int i = 0; i < 2000; ++i) row += std::to_string(i) + ", ";
  write(row + "1\n");
  const Refusal refused = refusal(row + "1\n");
  EXPECT_EQ(refused.line, 0);
  EXPECT_THAT(refused.message, HasSubstr("one row of 2001 numbers"));
  const std::string file = (folder_ / "data.txt").string();
  EXPECT_THAT(refused.message, HasSubstr("`tr -s ', \\t\\r' '\\n' < " + file + " > lines.txt`"));
  // The line to be pasted does what it says.
  const std::string lines = (folder_ / "lines.txt").string();
  EXPECT_EQ(std::system(("tr -s ', \\t\\r' '\\n' < " + file + " > " + lines).c_str()), 0);
  const auto table = recorded::read_table(lines, recorded::Rows::several);
  EXPECT_THAT(table.columns, ElementsAre("value"));
  EXPECT_EQ(table.rows(), 2001u);
  EXPECT_EQ(read("a b\n1 2\n").rows(), 1u);
}

TEST_F(Recorded, BoundsWhatItSaysOfALongLine) {
  const std::string word(100000, 'x');
  const Refusal refused = refusal("1\n" + word + "\n");
  EXPECT_EQ(std::pair(refused.line, refused.column), std::pair(2, 1));
  EXPECT_LT(refused.message.size(), 300u);
}

TEST_F(Recorded, NamesBinaryFiles) {
  using namespace std::string_literals;
  const std::vector<std::pair<std::string, std::string>> kinds{
      {"\x89PNG\r\n\x1a\n\0\0\0\rIHDR"s, "PNG"},  {"PK\x03\x04\x14\0\0\0"s, "unzip"},
      {"\x89HDF\r\n\x1a\n\0\0"s, "HDF5"},         {"\x7f"s + "ELF\x02\x01\x01\0"s, "a program"},
      {"\xff\xfe\x31\0\n\0"s, "iconv -f UTF-16"}, {"\x76\x2f\x31\x01\x02\0\0\0"s, "OpenEXR"},
      {"PF\n1 1\n-1\n\0\0\x80?"s, "PFM"},         {"1 2\n3 \0 4\n"s, "binary"},
  };
  for (const auto& [bytes, said] : kinds) {
    const std::string file = write(bytes);
    const std::string refused = said_of(file);
    EXPECT_EQ(refused.find(file + ": "), 0u) << said << ": without a line";
    EXPECT_THAT(refused, AllOf(HasSubstr("is a binary file, not text"), HasSubstr(said)));
    EXPECT_EQ(refused.find_first_of("\x7f\x89\xff\0"s), std::string::npos) << said;
  }
  // Letters alone make no picture.
  EXPECT_THAT(read("PF\n1\n2\n").columns, ElementsAre("PF"));
}

const std::string of_zstd("\x28\xb5\x2f\xfd\0\0\0\0", 8);
const std::string of_zip("PK\x03\x04\0\0\0\0", 8);
const std::string of_utf16("\xff\xfe\x31\0\n\0", 6);
const std::string of_hdf5("\x89HDF\r\n\x1a\n\0", 9);

// What is to be pasted can be pasted.
TEST_F(Recorded, QuotesTheNameOfABinaryFile) {
  const std::string file = (folder_ / "it's \"my\" file").string();
  const auto said = [&](const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
    return said_of(file);
  };
  const std::string folder = folder_.string();
  const std::string in_shell = "'" + folder + "/it'\\''s \"my\" file'";
  const std::string in_python = "\"" + folder + "/it's \\\"my\\\" file\"";
  EXPECT_THAT(said(of_zstd), HasSubstr("`zstd -dc " + in_shell + " | assay …`"));
  EXPECT_THAT(said(of_zip), HasSubstr("`unzip " + in_shell + "`"));
  EXPECT_THAT(said(of_utf16), HasSubstr("-t UTF-8 " + in_shell + " > mine.txt`"));
  EXPECT_THAT(said(of_hdf5), HasSubstr("h5py.File(" + in_python + ")"));
  EXPECT_THAT(said(std::string(8, '\0')), HasSubstr("numpy.fromfile(" + in_python + ")"));
}

/// What is said of standard input that holds a file's bytes.
std::string refusal_of_standard_input(const std::string& file) {
  const int standard = dup(STDIN_FILENO);
  const int other = open(file.c_str(), O_RDONLY);
  EXPECT_EQ(dup2(other, STDIN_FILENO), STDIN_FILENO);
  std::string said;
  try {
    recorded::read_table("-", recorded::Rows::several);
  } catch (const LineError& error) {
    said = error.what() + std::string(" in ") + error.line();
  } catch (const InputError& error) {
    said = error.message();
  }
  dup2(standard, STDIN_FILENO);
  close(other);
  close(standard);
  return said;
}

TEST_F(Recorded, SaysWhatToPutBeforeAssayWhereStandardInputIsBinary) {
  const auto said = [&](const std::string& bytes) {
    return refusal_of_standard_input(write(bytes));
  };
  EXPECT_THAT(said(of_zstd), HasSubstr("put `zstd -dc |` before `assay`"));
  EXPECT_THAT(said(of_utf16), HasSubstr("put `iconv -f UTF-16 -t UTF-8 |` before `assay`"));
  EXPECT_THAT(said(of_zip), HasSubstr("`unzip FILE`"));
  EXPECT_THAT(said(of_hdf5), HasSubstr("h5py.File(\"FILE\")"));
  EXPECT_THAT(said(std::string(8, '\0')), HasSubstr("numpy.fromfile(\"FILE\")"));
  EXPECT_THAT(said(packed("1 2 3\n")), HasSubstr("`zcat | tr -s ' \\t\\r' '\\n'`"));
  for (const std::string& bytes :
       {of_zstd, of_zip, of_utf16, of_hdf5, std::string(8, '\0'), packed("1 2 3\n")}) {
    EXPECT_THAT(said(bytes), Not(HasSubstr("standard input")));
  }
}

TEST_F(Recorded, ReadsAPipeOnceAndForAll) {
  const std::string pipe = (folder_ / "pipe").string();
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  std::thread writer([&] {
    std::ofstream to(pipe);
    to << "a b\n1 2\n";
    to.flush();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    to << "3 4\n";
  });
  const auto a = draws::prepare("recorded", "{file: pipe, column: a}", folder_.string());
  const auto b = draws::prepare("recorded", "{file: pipe, column: b}", folder_.string());
  writer.join();
  EXPECT_THAT(draws::observe(a, 2)[0].values, ElementsAre(1, 3));
  EXPECT_THAT(draws::observe(b, 2)[0].values, ElementsAre(2, 4));
  EXPECT_EQ(a.setup->data_file(), b.setup->data_file());
  EXPECT_TRUE(recorded::is_read_once(pipe));
  EXPECT_TRUE(recorded::is_read_once("-"));
  EXPECT_TRUE(recorded::is_read_once("/dev/fd/4711"));
  EXPECT_FALSE(recorded::is_read_once(write("1\n")));
  EXPECT_FALSE(recorded::is_read_once((folder_ / "none").string()));
}

TEST_F(Recorded, ReadsStandardInput) {
  const std::string said = refusal_of_standard_input(write("1\n2\nx\n"));
  EXPECT_THAT(said, AllOf(StartsWith("standard input:3:1: "), EndsWith(" in x")));
}

std::atomic<bool> asked_to_stop{false};

// Though no signal reaches the thread that reads, and no byte comes.
TEST_F(Recorded, StopsReadingWhenAsked) {
  const std::string pipe = (folder_ / "pipe").string();
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  asked_to_stop = false;
  set_stop_question([] { return asked_to_stop.load(); });
  std::thread user([&] {
    std::ofstream to(pipe);
    to << "1\n";
    to.flush();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    asked_to_stop = true;
    std::this_thread::sleep_for(std::chrono::seconds(2));
  });
  for (const std::string& file : {pipe, write("1\n2\n")}) {
    EXPECT_EQ(thrown([&] { recorded::read_table(file, recorded::Rows::several); }), "interrupted");
  }
  set_stop_question(nullptr);
  user.join();
}

TEST_F(Recorded, ShowsALineWithoutItsEnd) {
  for (const char* text : {"1\r\nx\r\n", "1\nx\n", "1\r\nx\r"}) {
    try {
      read(text);
      ADD_FAILURE() << "`x` was taken";
    } catch (const LineError& error) {
      EXPECT_EQ(error.line(), "x");
    }
  }
}

TEST_F(Recorded, RefusesAFileThatChangesMeanwhile) {
  for (const bool longer : {true, false}) {
    std::string numbers;
    for (int i = 0; i < 100000; ++i) numbers += "1\n";
    recorded::ByteSource source(write(numbers));
    source.take(source.look().size());
    std::filesystem::resize_file(folder_ / "data.txt", longer ? 300000 : 100000);
    EXPECT_THAT(thrown<InputError>([&] {
                  while (!source.look().empty()) source.take(source.look().size());
                }),
                HasSubstr("changed while it was read"));
  }
}

// ---- gzip

TEST_F(Recorded, UnpacksGzip) {
  std::string text = "x\n";
  for (int i = 0; i < 200000; ++i) text += std::to_string(i) + "\n";
  const auto table = read(packed(text));
  EXPECT_THAT(table.columns, ElementsAre("x"));
  ASSERT_EQ(table.rows(), 200000u);
  EXPECT_EQ(table.values.back(), 199999);
  // One member after another is one text (RFC 1952).
  EXPECT_THAT(read(packed("1\n2\n") + packed("") + packed("3\n")).values, ElementsAre(1, 2, 3));
  const Refusal refused = refusal(packed("1\n2x\n"));
  EXPECT_EQ(std::pair(refused.line, refused.column), std::pair(2, 1));
  EXPECT_THAT(refusal(packed(packed("1\n"))).message, HasSubstr("binary"));
}

TEST_F(Recorded, RefusesDamagedGzip) {
  std::string text;
  for (int i = 0; i < 1000; ++i) text += std::to_string(i * 7919 % 1000) + "\n";
  const std::string whole = packed(text);
  for (const std::size_t size :
       {std::size_t{3}, std::size_t{15}, whole.size() / 2, whole.size() - 1}) {
    expect_refused(whole.substr(0, size), {0, 0}, "cut short");
  }
  std::string damaged = whole;
  damaged[damaged.size() - 6] ^= 0x10;  // the check sum
  expect_refused(damaged, {0, 0}, "damaged");
  expect_refused(whole + "junk", {0, 0}, "damaged");
}

// gzip(1) and tapes fill up a block so.
TEST_F(Recorded, TakesZerosBehindGzip) {
  const std::string zeros(100000, '\0');
  EXPECT_THAT(read(packed("1\n2\n") + zeros).values, ElementsAre(1, 2));
  EXPECT_THAT(read(packed("1\n") + zeros + packed("2\n")).values, ElementsAre(1, 2));
  expect_refused(packed("1\n2\n") + zeros + "junk", {0, 0}, "damaged");
}

// ---- numpy's format, https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html

std::string npy(const std::string& type, bool fortran, const std::string& shape,
                const std::string& data, char version = 1) {
  std::string header = "{'descr': '" + type +
                       "', 'fortran_order': " + (fortran ? "True" : "False") +
                       ", 'shape': " + shape + ", }";
  const std::size_t fixed = version == 1 ? 10 : 12;
  while ((fixed + header.size() + 1) % 64 != 0) header += ' ';
  header += '\n';
  std::string text = std::string("\x93NUMPY") + version + '\0';
  for (std::size_t i = 0; i < fixed - 8; ++i) {
    text += static_cast<char>(header.size() >> (8 * i) & 0xFF);
  }
  return text + header + data;
}

template <class Number>
std::string bytes_of(const std::vector<Number>& numbers, bool reversed = false) {
  std::string text;
  for (const Number& number : numbers) {
    std::string one(sizeof(Number), '\0');
    std::memcpy(one.data(), &number, sizeof(Number));
    if (reversed) std::ranges::reverse(one);
    text += one;
  }
  return text;
}

TEST_F(Recorded, ReadsArraysOfNumpy) {
  const std::vector<double> doubles{1.5, -2, 1e300};
  EXPECT_THAT(read(npy("<f8", false, "(3,)", bytes_of(doubles))).values, ElementsAreArray(doubles));
  EXPECT_THAT(read(npy(">f8", false, "(3,)", bytes_of(doubles, true))).values,
              ElementsAreArray(doubles));
  EXPECT_THAT(read(npy("<f4", false, "(2,)", bytes_of<float>({0.1F, -3}))).values,
              ElementsAre(static_cast<double>(0.1F), -3));
  EXPECT_THAT(
      read(npy(">i4", false, "(2,)", bytes_of<std::int32_t>({-7, 2000000000}, true))).values,
      ElementsAre(-7, 2000000000));
  EXPECT_THAT(read(npy("|i1", false, "(2,)", "\xff\x7f")).values, ElementsAre(-1, 127));
  EXPECT_THAT(read(npy("|u1", false, "(2,)", "\xff\x7f")).values, ElementsAre(255, 127));
  EXPECT_THAT(read(npy("<u8", false, "(1,)", bytes_of<std::uint64_t>({1ULL << 63}))).values,
              ElementsAre(0x1p63));
  EXPECT_THAT(read(npy("<i2", false, "(1,)", bytes_of<std::int16_t>({-300}))).values,
              ElementsAre(-300));
  const auto table =
      read(npy("<i8", false, "(2, 3)", bytes_of<std::int64_t>({1, 2, 3, 4, 5, -6}), 2));
  EXPECT_THAT(table.columns, ElementsAre("value1", "value2", "value3"));
  EXPECT_THAT(table.values, ElementsAre(1, 2, 3, 4, 5, -6));
  EXPECT_THAT(read(npy("<f8", true, "(2, 3)", bytes_of<double>({1, 4, 2, 5, 3, 6}), 3)).values,
              ElementsAre(1, 2, 3, 4, 5, 6));
  EXPECT_THAT(read(packed(npy("<f8", false, "(3,)", bytes_of(doubles)))).values,
              ElementsAreArray(doubles));
}

TEST_F(Recorded, KnowsWhereAnElementStands) {
  const auto rows = prepare(npy("<f4", false, "(2,)", bytes_of<float>({1, 2})));
  const std::string file = std::filesystem::weakly_canonical(folder_ / "data.txt").string();
  EXPECT_EQ(recorded::observation_place(*rows.setup, {.index = 1}), file + "[1]");
  EXPECT_EQ(recorded::observation_place(*rows.setup, {.index = 2}), "");
}

TEST_F(Recorded, RefusesOtherArraysOfNumpy) {
  const std::string data(64, '\0');
  const auto refused = [&](const std::string& text, const std::string& message) {
    expect_refused(text, {0, 0}, message);
  };
  refused(npy("<c16", false, "(4,)", data), "the type `<c16`");
  refused(npy("<c16", false, "(4,)", data), "a.real");
  refused(npy("<f2", false, "(32,)", data), "a.astype(\"f8\")");
  refused(npy("|O", false, "(4,)", data), "the type `|O`");
  refused(npy("<f8', 'x", false, "(8,)", data), "damaged");
  refused(npy("<f8", false, "(2, 2, 2)", data), "3 dimensions (2 x 2 x 2)");
  refused(npy("<f8", false, "()", data), "one number");
  refused(npy("<f8", false, "(0,)", ""), "empty");
  refused(npy("<f8", false, "(3, 0)", ""), "empty");
  refused(npy("<f8", false, "(1, 8)", data), "one row of 8 numbers");
  refused(npy("<f8", false, "(9,)", data), "the array has 9 numbers,\n  and 8 of them are there");
  refused(npy("<f8", false, "(7,)", data), "bytes follow the array");
  refused(npy("<f8", false, "(8,)", data, 4), "does not know");
  refused(npy("<f8", false, "(1000000000000, 1000000000000)", data), "does not fit into memory");
  refused(npy("<f8", false, "(99999999999999999999,)", data), "damaged");
  refused(npy("<f8", false, "(-8,)", data), "damaged");
  refused(npy("<f8", false, "(8,", data), "damaged");
  std::string huge = npy("<f8", false, "(8,)", data, 2);
  huge[10] = huge[11] = '\x7f';  // a header of 2 GB
  refused(huge, "damaged");
  const std::string whole = npy("<f8", false, "(8,)", data);
  for (std::size_t size = 6; size < whole.size(); ++size) {
    EXPECT_NE(refusal(whole.substr(0, size)).line, -1) << size;
  }
  std::string records = whole;
  const std::string type = "'<f8'";
  records.replace(records.find(type), type.size(), "[('')]");
  refused(records.erase(records.find("  "), 1), "array of records");
}

TEST_F(Recorded, TellsDataApart) {
  const auto digest = [&](const std::string& text) {
    return recorded::observations_digest(*prepare(text).setup);
  };
  ASSERT_TRUE(digest("1\n2\n").has_value());
  EXPECT_EQ(digest("1\n2\n"), digest("# by another hand\n1.0\n2\n"));
  EXPECT_NE(digest("1\n2\n"), digest("2\n1\n"));
  EXPECT_NE(digest("1\n2\n"), digest("a\n1\n2\n"));
}

}  // namespace
}  // namespace assay
