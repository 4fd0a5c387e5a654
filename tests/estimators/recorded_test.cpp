#include <fcntl.h>
#include <sys/stat.h>
#include <zlib.h>

#include "estimators/core/waiting.h"
#include "estimators/ready_made.h"
#include "recorded/byte_source.h"
#include "recorded/table.h"
#include "tests/estimators/prelude.h"

namespace assay {
namespace {

/// Packs a text as gzip does it.
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

/// An array of numpy, https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html
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

class Recorded : public InFolder {
 protected:
  std::string write(const std::string& text) const { return place_.write("data.txt", text); }
  recorded::Table read(const std::string& text) const {
    return recorded::read_table(write(text), recorded::Rows::several);
  }

  /// "LINE:COLUMN message".
  std::string refusal(const std::string& text) const {
    try {
      read(text);
    } catch (const InputError& error) {
      EXPECT_EQ(error.where().file, file("data.txt"));
      return std::to_string(error.where().line) + ":" + std::to_string(error.where().column) + " " +
             error.message();
    }
    return "nothing was refused";
  }
  /// The file as a whole is refused.
  void expect_refused(const std::string& text, const std::string& message) const {
    EXPECT_THAT(refusal(text), AllOf(StartsWith("0:0 "), HasSubstr(message)));
  }

  draws::Prepared prepare(const std::string& text, const std::string& more = "") const {
    write(text);
    return draws::prepare("recorded", "{file: data.txt" + more + "}", folder_.string());
  }
  template <class Error = InputError>
  std::string said_of(const std::string& name) const {
    return thrown<Error>([&] { recorded::read_table(name, recorded::Rows::several); });
  }
  /// Why a plugin's file is refused.
  std::string said_of_file(const std::string& name) const {
    return draws::refusal("recorded", "{file: " + name + "}", folder_.string());
  }
};

TEST_F(Recorded, ReadsRowsAsProgramsWriteThem) {
  using Texts = std::vector<std::string>;
  struct Read {
    std::string text;
    Texts columns;
    std::vector<double> values;
  };
  for (const auto& [text, columns, values] : std::vector<Read>{
           {"# columns: a b\n1 2.5\n-3e-2,\t4 # note\n\n  +5   6\r\n",
            {"a", "b"},
            {1, 2.5, -0.03, 4, 5, 6}},
           // Columns without names.
           {"1\n2", {"value"}, {1, 2}},
           {"# made by hand\n1 2 3\n4 5 6\n", {"value1", "value2", "value3"}, {1, 2, 3, 4, 5, 6}},
           {"\xef\xbb\xbf# columns: x, y\n1,2\n", {"x", "y"}, {1, 2}},
           // Names in the first line without numbers.
           {"x,y\n1,2\n3,4\n", {"x", "y"}, {1, 2, 3, 4}},
           {"\xef\xbb\xbf\"x, mean\",\"the \"\"y\"\"\"\r\n\"1\",2\r\n",
            {"x, mean", "the \"y\""},
            {1, 2}},
           {"x y\n1 2\n", {"x", "y"}, {1, 2}},
           {"value\n0.5\n", {"value"}, {.5}},
           {"# of a run\n\nvalue # in W\n0.5\n", {"value"}, {.5}},
           {"PF\n1\n2\n", {"PF"}, {1, 2}},  // these letters alone make no picture
           // pandas.DataFrame({'a': [1, 3], 'b': [2, 4]}).to_csv() and R's write.csv().
           {",a,b\n0,1,2\n1,3,4\n", {"a", "b"}, {1, 2, 3, 4}},
           {"\"\",\"a\",\"b\"\n\"r1\",1,2\n\"r2\",3,4\n", {"a", "b"}, {1, 2, 3, 4}},
           {"\"x\";\"y\"\n1,5;-2,25e1\n3;4.5\n", {"x", "y"}, {1.5, -22.5, 3, 4.5}},
           {"frame,a,b\nf1,1,2\nf2,3,4\n", {"a", "b"}, {1, 2, 3, 4}},
           {"x pos\ty pos\n1\t2\n3\t4\t\n", {"x pos", "y pos"}, {1, 2, 3, 4}},
           // Every bit of a number.
           {"0.1\n", {"value"}, {.1}},
           {"1.7976931348623157e308\n", {"value"}, {std::numeric_limits<double>::max()}},
           {"4.9406564584124654e-324\n", {"value"}, {std::numeric_limits<double>::denorm_min()}}}) {
    const auto table = read(text);
    EXPECT_EQ(table.columns, columns) << text;
    EXPECT_EQ(table.values, values) << text;
    EXPECT_EQ(table.rows(), values.size() / columns.size()) << text;
  }
  EXPECT_THAT(read("x,y\n1,2\n3,4\n").lines, ElementsAre(2, 3));
}

TEST_F(Recorded, KnowsWhereARowOrAnElementStands) {
  const std::string at = std::filesystem::weakly_canonical(folder_ / "data.txt").string();
  const auto expect_places = [&](const std::string& text, const std::vector<std::string>& places) {
    const draws::Prepared rows = prepare(text);
    for (std::size_t i = 0; i < places.size(); ++i) {
      EXPECT_EQ(rows.setup->place_of({.index = i}), places[i]) << i;
    }
  };
  expect_places("# columns: a\n1\n\n2 # note\n# more\nnan\n",
                {at + ":2", at + ":4", at + ":6", ""});
  expect_places(npy("<f4", false, "(2,)", bytes_of<float>({1, 2})), {at + "[0]", at + "[1]", ""});
}

TEST_F(Recorded, KeepsValuesThatAreNotFinite) {
  const auto table = read("1 inf\n-inf nan\n");
  EXPECT_EQ(table.values[1], std::numeric_limits<double>::infinity());
  EXPECT_EQ(table.values[2], -std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(table.values[3]));
}

TEST_F(Recorded, RefusesWhatAreNoRows) {
  for (const auto& [text, said] : refused_texts("rows")) {
    const std::string place = said.substr(0, said.find(' ') + 1);
    EXPECT_THAT(refusal(text), AllOf(StartsWith(place), HasSubstr(said.substr(place.size()))))
        << text;
  }
}

TEST_F(Recorded, RefusesAFileThatIsNotThereAndAFolder) {
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
  EXPECT_THROW(draws::observe(plugin, 4), std::out_of_range);
  EXPECT_THROW(draws::observe(plugin, 1, 2), std::invalid_argument);
}

TEST_F(Recorded, PicksOneColumn) {
  const auto plugin = prepare("# columns: a b\n1 2\n3 4\n", ", column: b");
  ASSERT_EQ(plugin.setup->channels().size(), 1u);
  EXPECT_EQ(plugin.channel().name, "b");
  EXPECT_THAT(draws::observe(plugin, 2)[0].values, ElementsAre(2, 4));
  EXPECT_THAT(draws::refusal("recorded", "{file: data.txt, column: c}", folder_.string()),
              HasSubstr("parameter `column` must be a column of the file, but it is `c`; there is: "
                        "`a`, `b`"));
}

TEST_F(Recorded, AsksOfOneRowWhetherItsNumbersAreObservations) {
  std::string row;
  for (int i = 0; i < 2000; ++i) row += std::to_string(i) + ", ";
  const std::string refused = refusal(row + "1\n");
  const std::string pasted = "tr -s ', \\t\\r' '\\n' < " + file("data.txt") + " > lines.txt";
  EXPECT_THAT(refused, AllOf(StartsWith("0:"), HasSubstr("one row of 2001 numbers"),
                             HasSubstr("`" + pasted + "`")));
  // The line to be pasted does what it says.
  EXPECT_EQ(std::system(("cd " + folder_.string() + " && " + pasted).c_str()), 0);
  const auto table = recorded::read_table(file("lines.txt"), recorded::Rows::several);
  EXPECT_THAT(table.columns, ElementsAre("value"));
  EXPECT_EQ(table.rows(), 2001u);
  EXPECT_EQ(read("a b\n1 2\n").rows(), 1u);
}

/// The refusal of standard input that holds a file's bytes.
std::string refusal_of_standard_input(const std::string& file) {
  const int standard = dup(STDIN_FILENO);
  const int other = open(file.c_str(), O_RDONLY);
  EXPECT_EQ(dup2(other, STDIN_FILENO), STDIN_FILENO);
  std::string said;
  try {
    recorded::read_table("-", recorded::Rows::several);
  } catch (const InputError& error) {
    said = error.line() ? error.what() + (" in " + *error.line()) : error.message();
  }
  dup2(standard, STDIN_FILENO);
  close(other);
  close(standard);
  return said;
}

// The message holds a command that can be pasted.
TEST_F(Recorded, SaysWhatToDoWithABinaryFileOrStandardInput) {
  using namespace std::string_literals;
  const std::string place = file("it's \"my\" file");
  const std::string in_shell = "'" + folder_.string() + "/it'\\''s \"my\" file'";
  const std::string in_python = "\"" + folder_.string() + "/it's \\\"my\\\" file\"";
  struct Kind {
    std::string bytes;
    std::string said;
    std::string of_standard_input = "";
  };
  for (const auto& [bytes, said, of_standard_input] : std::vector<Kind>{
           {"\x89PNG\r\n\x1a\n\0\0\0\rIHDR"s, "PNG"},
           {"\x7f"s + "ELF\x02\x01\x01\0"s, "a program"},
           {"\x76\x2f\x31\x01\x02\0\0\0"s, "OpenEXR"},
           {"PF\n1 1\n-1\n\0\0\x80?"s, "PFM"},
           {"1 2\n3 \0 4\n"s, "binary"},
           {"PK\x03\x04\x14\0\0\0"s, "`unzip " + in_shell + "`", "`unzip FILE`"},
           {"\x89HDF\r\n\x1a\n\0\0"s, "HDF5", "h5py.File(\"FILE\")"},
           {"\x89HDF\r\n\x1a\n\0\0"s, "h5py.File(" + in_python + ")"},
           {"\xff\xfe\x31\0\n\0"s, "iconv -f UTF-16 -t UTF-8 " + in_shell + " > mine.txt`",
            "put `iconv -f UTF-16 -t UTF-8 |` before `assay`"},
           {"\x28\xb5\x2f\xfd\0\0\0\0"s, "`zstd -dc " + in_shell + " | assay …`",
            "put `zstd -dc |` before `assay`"},
           {std::string(8, '\0'), "numpy.fromfile(" + in_python + ")",
            "numpy.fromfile(\"FILE\")"}}) {
    std::ofstream(place, std::ios::binary) << bytes;
    const std::string refused = said_of(place);
    EXPECT_THAT(refused, AllOf(StartsWith(place + ": "), HasSubstr(said),
                               HasSubstr("is a binary file, not text")));
    EXPECT_EQ(refused.find_first_of("\x7f\x89\xff\0"s), std::string::npos) << said;
    EXPECT_THAT(refusal_of_standard_input(place),
                AllOf(HasSubstr(of_standard_input), Not(HasSubstr("standard input"))));
  }
  EXPECT_THAT(refusal_of_standard_input(write("1\n2\nx\n")),
              AllOf(StartsWith("standard input:3:1: "), EndsWith(" in x")));
  EXPECT_THAT(refusal_of_standard_input(write(packed("1 2 3\n"))),
              AllOf(HasSubstr("`zcat | tr -s ' \\t\\r' '\\n'`"), Not(HasSubstr("standard input"))));
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

std::atomic<bool> asked_to_stop{false};

// Though no signal reaches the thread that reads, and no byte comes.
TEST_F(Recorded, StopsReadingWhenAsked) {
  const std::string pipe = file("pipe");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  asked_to_stop = false;
  std::atomic<bool> over = false;
  set_stop_question([] { return asked_to_stop.load(); });
  std::thread user([&] {
    std::ofstream to(pipe);
    to << "1\n";
    to.flush();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    asked_to_stop = true;
    while (!over) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  });
  for (const std::string& file : {pipe, write("1\n2\n")})
    EXPECT_EQ(said_of<std::exception>(file), "interrupted");
  over = true;
  set_stop_question(nullptr);
  user.join();
}

TEST_F(Recorded, ShowsALineWithoutItsEndAndOfALongOneItsBeginning) {
  EXPECT_LT(refusal("1\n" + std::string(100000, 'x') + "\n").size(), 300u);
  for (const char* text : {"1\r\nx\r\n", "1\nx\n", "1\r\nx\r"}) {
    try {
      read(text);
      ADD_FAILURE() << "`x` was taken";
    } catch (const InputError& error) {
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

TEST_F(Recorded, UnpacksGzip) {
  std::string text = "x\n";
  for (int i = 0; i < 200000; ++i) text += std::to_string(i) + "\n";
  const auto table = read(packed(text));
  EXPECT_THAT(table.columns, ElementsAre("x"));
  ASSERT_EQ(table.rows(), 200000u);
  EXPECT_EQ(table.values.back(), 199999);
  // One member after another is one text (RFC 1952).
  EXPECT_THAT(read(packed("1\n2\n") + packed("") + packed("3\n")).values, ElementsAre(1, 2, 3));
  EXPECT_THAT(refusal(packed("1\n2x\n")), StartsWith("2:1 "));
  EXPECT_THAT(refusal(packed(packed("1\n"))), HasSubstr("binary"));
  // gzip(1) and tapes fill up a block with zeros.
  const std::string zeros(100000, '\0');
  EXPECT_THAT(read(packed("1\n2\n") + zeros).values, ElementsAre(1, 2));
  EXPECT_THAT(read(packed("1\n") + zeros + packed("2\n")).values, ElementsAre(1, 2));
  expect_refused(packed("1\n2\n") + zeros + "junk", "damaged");
}

TEST_F(Recorded, RefusesDamagedGzip) {
  std::string text;
  for (int i = 0; i < 1000; ++i) text += std::to_string(i * 7919 % 1000) + "\n";
  const std::string whole = packed(text);
  for (const std::size_t size :
       {std::size_t{3}, std::size_t{15}, whole.size() / 2, whole.size() - 1}) {
    expect_refused(whole.substr(0, size), "cut short");
  }
  std::string damaged = whole;
  damaged[damaged.size() - 6] ^= 0x10;  // the check sum
  expect_refused(damaged, "damaged");
  expect_refused(whole + "junk", "damaged");
}

TEST_F(Recorded, ReadsArraysOfNumpy) {
  const auto numbers = [&](const char* type, const char* shape, const std::string& data) {
    return read(npy(type, false, shape, data)).values;
  };
  const std::vector<double> doubles{1.5, -2, 1e300};
  EXPECT_EQ(numbers("<f8", "(3,)", bytes_of(doubles)), doubles);
  EXPECT_EQ(numbers(">f8", "(3,)", bytes_of(doubles, true)), doubles);
  EXPECT_EQ(read(packed(npy("<f8", false, "(3,)", bytes_of(doubles)))).values, doubles);
  EXPECT_THAT(numbers("<f4", "(2,)", bytes_of<float>({0.1F, -3})),
              ElementsAre(static_cast<double>(0.1F), -3));
  EXPECT_THAT(numbers(">i4", "(2,)", bytes_of<std::int32_t>({-7, 2000000000}, true)),
              ElementsAre(-7, 2000000000));
  EXPECT_THAT(numbers("|i1", "(2,)", "\xff\x7f"), ElementsAre(-1, 127));
  EXPECT_THAT(numbers("|u1", "(2,)", "\xff\x7f"), ElementsAre(255, 127));
  EXPECT_THAT(numbers("<u8", "(1,)", bytes_of<std::uint64_t>({1ULL << 63})), ElementsAre(0x1p63));
  EXPECT_THAT(numbers("<i2", "(1,)", bytes_of<std::int16_t>({-300})), ElementsAre(-300));
  const auto table =
      read(npy("<i8", false, "(2, 3)", bytes_of<std::int64_t>({1, 2, 3, 4, 5, -6}), 2));
  EXPECT_THAT(table.columns, ElementsAre("value1", "value2", "value3"));
  EXPECT_THAT(table.values, ElementsAre(1, 2, 3, 4, 5, -6));
  EXPECT_THAT(read(npy("<f8", true, "(2, 3)", bytes_of<double>({1, 4, 2, 5, 3, 6}), 3)).values,
              ElementsAre(1, 2, 3, 4, 5, 6));
}

TEST_F(Recorded, RefusesOtherArraysOfNumpy) {
  const std::string data(64, '\0');
  struct Case {
    const char* type;
    const char* shape;
    const char* said;
    std::string data = std::string(64, '\0');
  };
  for (const auto& [type, shape, said, bytes] :
       {Case{"<c16", "(4,)", "the type `<c16`"},
        {"<c16", "(4,)", "a.real"},
        {"<f2", "(32,)", "a.astype(\"f8\")"},
        {"|O", "(4,)", "the type `|O`"},
        {"<f8', 'x", "(8,)", "damaged"},
        {"<f8", "(2, 2, 2)", "3 dimensions (2 x 2 x 2)"},
        {"<f8", "()", "one number"},
        {"<f8", "(0,)", "empty", ""},
        {"<f8", "(3, 0)", "empty", ""},
        {"<f8", "(1, 8)", "one row of 8 numbers"},
        {"<f8", "(9,)", "the array has 9 numbers, and 8 of them are there"},
        {"<f8", "(7,)", "bytes follow the array"},
        {"<f8", "(1000000000000, 1000000000000)", "does not fit into memory"},
        {"<f8", "(99999999999999999999,)", "damaged"},
        {"<f8", "(-8,)", "damaged"},
        {"<f8", "(8,", "damaged"}}) {
    expect_refused(npy(type, false, shape, bytes), said);
  }
  expect_refused(npy("<f8", false, "(8,)", data, 4), "does not know");
  std::string huge = npy("<f8", false, "(8,)", data, 2);
  huge[10] = huge[11] = '\x7f';  // a header of 2 GB
  expect_refused(huge, "damaged");
  const std::string whole = npy("<f8", false, "(8,)", data);
  for (std::size_t size = 6; size < whole.size(); ++size) {
    EXPECT_NE(refusal(whole.substr(0, size)), "nothing was refused") << size;
  }
  std::string records = whole;
  const std::string type = "'<f8'";
  records.replace(records.find(type), type.size(), "[('')]");
  expect_refused(records.erase(records.find("  "), 1), "array of records");
}

TEST_F(Recorded, TellsDataApart) {
  const auto digest = [&](const std::string& text) { return prepare(text).setup->data_digest(); };
  ASSERT_TRUE(digest("1\n2\n").has_value());
  EXPECT_EQ(digest("1\n2\n"), digest("# by another hand\n1.0\n2\n"));
  EXPECT_NE(digest("1\n2\n"), digest("2\n1\n"));
  EXPECT_NE(digest("1\n2\n"), digest("a\n1\n2\n"));
}

}  // namespace
}  // namespace assay
