#include "recorded/foreign_formats.h"

#include <algorithm>
#include <array>

#include "estimators/core/quoting.h"
#include "estimators/ready_made.h"
#include "recorded/byte_source.h"

namespace assay::recorded {

namespace {

using namespace std::string_view_literals;

struct Format {
  std::string_view magic;
  std::string_view what;         ///< behind "it is a binary file, not text: "
  std::string_view mend;         ///< $ stands for the file as a shell takes it, @ as Python does
  std::string_view filter = "";  ///< a command that makes text of it, from its input to its output
};

constexpr std::string_view as_exr =
    "a mean of pixels needs them unrounded: render to OpenEXR (.exr)";

constexpr std::string_view as_file =
    "name the file of the picture itself: it is not read from pipes or packed";

constexpr std::array formats{
    Format{"\x76\x2f\x31\x01"sv, "an OpenEXR picture", as_file},
    Format{"\x89PNG"sv, "a PNG picture", as_file},
    Format{"PF\n"sv, "a PFM picture", as_file},
    Format{"\xff\xd8\xff"sv, "a JPEG picture", as_exr},
    Format{"II*\0"sv, "a TIFF picture", as_exr},
    Format{"MM\0*"sv, "a TIFF picture", as_exr},
    Format{"#?RADIANCE"sv, "a Radiance picture", as_exr},
    Format{"PK\x03\x04"sv, "a zip archive, as .npz and .xlsx are",
           "`unzip $` gives the arrays of an .npz as .npy files, which can be read;\n"
           "  save a spreadsheet as CSV"},
    Format{"\x89HDF\r\n\x1a\n"sv, "HDF5",
           "in Python `numpy.save(\"mine.npy\", h5py.File(@)[\"NAME\"][:])`"},
    Format{"MATLAB 5.0 MAT-file"sv, "MATLAB's .mat",
           "in MATLAB `writematrix(x, 'mine.csv')`, x being the matrix"},
    Format{"PAR1"sv, "Parquet", "in Python `pandas.read_parquet(@).to_csv(\"mine.csv\")`"},
    Format{"SQLite format 3"sv, "an SQLite database",
           "`sqlite3 -csv -header $ 'select x from t' > mine.csv`"},
    Format{"\x28\xb5\x2f\xfd"sv, "compressed by zstd",
           "`zstd -dc $ | assay …` with `file=-`, or compress by gzip", "zstd -dc"},
    Format{"\xfd\x37zXZ\0"sv, "compressed by xz",
           "`xz -dc $ | assay …` with `file=-`, or compress by gzip", "xz -dc"},
    Format{"BZh"sv, "compressed by bzip2",
           "`bzip2 -dc $ | assay …` with `file=-`, or compress by gzip", "bzip2 -dc"},
    Format{"\x7f"
           "ELF"sv,
           "a program", "let it write into a pipe: `PROGRAM | assay …` with `file=-`"},
    Format{"\xff\xfe"sv, "UTF-16, as PowerShell and Excel write it",
           "`iconv -f UTF-16 -t UTF-8 $ > mine.txt` makes text of it", "iconv -f UTF-16 -t UTF-8"},
    Format{"\xfe\xff"sv, "UTF-16", "`iconv -f UTF-16 -t UTF-8 $ > mine.txt` makes text of it",
           "iconv -f UTF-16 -t UTF-8"},
};

/// The name of a file in a line to paste. Only its user knows what a pipe came from.
std::string to_paste(const std::string& file) {
  return file == called("-") || is_read_once(file) ? "FILE" : file;
}

std::string mend_of(const Format& format, const std::string& file) {
  if (file == called("-") && !format.filter.empty()) {
    return "put `" + std::string(format.filter) + " |` before `assay`";
  }
  std::string mend(format.mend);
  const std::size_t place = mend.find_first_of("$@");
  if (place == mend.npos) return mend;
  const std::string name = to_paste(file);
  return mend.replace(place, 1, mend[place] == '$' ? shell_quoted(name) : python_quoted(name));
}

}  // namespace

std::size_t first_binary_byte(std::string_view bytes) {
  const auto binary = [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    constexpr unsigned char escape = 0x1b;
    return (byte < 0x20 && (byte < '\b' || byte > '\r') && byte != escape) || byte == 0x7f;
  };
  const auto found = std::ranges::find_if(bytes, binary);
  return found == bytes.end() ? bytes.npos : static_cast<std::size_t>(found - bytes.begin());
}

std::string no_text(std::string_view beginning, const std::string& file) {
  const bool text = first_binary_byte(beginning) == beginning.npos;
  for (const Format& format : formats) {
    if (!beginning.starts_with(format.magic)) continue;
    // A text may begin by chance as a picture does: `PF`, `BZh`.
    const bool printable = first_binary_byte(format.magic) == format.magic.npos &&
                           static_cast<unsigned char>(format.magic[0]) < 0x80;
    if (printable && text) continue;
    return "it is a binary file, not text: " + std::string(format.what) + ";\n  " +
           mend_of(format, file);
  }
  if (text) return "";
  return "it is a binary file, not text; write the numbers as text, an observation a\n"
         "  line, or as .npy, from raw doubles in Python:\n"
         "  `numpy.save(\"mine.npy\", numpy.fromfile(" +
         python_quoted(to_paste(file)) + "))`";
}

}  // namespace assay::recorded
