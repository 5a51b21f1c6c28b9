// Height fields from images and from HDF5: values, and errors of invalid files
#include <hdf5.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "unit/description/ground_fixture.h"

namespace taut::test {
namespace {

// --- images -------------------------------------------------------------------------------------

std::string BigEndian(std::uint32_t value) {
  std::string bytes;
  for (int k = 3; k >= 0; --k) bytes += static_cast<char>(value >> (8 * k) & 0xff);
  return bytes;
}
std::string Chunk(const std::string& kind_and_data) {
  std::uint32_t crc = 0xffffffff;
  for (const char c : kind_and_data) {
    crc ^= static_cast<unsigned char>(c);
    for (int k = 0; k < 8; ++k) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return BigEndian(static_cast<std::uint32_t>(kind_and_data.size() - 4)) + kind_and_data +
         BigEndian(~crc);
}
/// Returns an uncompressed PNG of these bytes, `rows` rows of them. `colour`: 0 gray, 2 RGB.
std::string Png(std::uint32_t columns, std::uint32_t rows, int bits, int colour,
                const std::string& samples) {
  std::string raw;
  const std::size_t row = samples.size() / rows;
  for (std::size_t j = 0; j < rows; ++j) raw += '\0' + samples.substr(j * row, row);
  std::uint32_t a = 1, b = 0;
  for (const char c : raw) a = (a + static_cast<unsigned char>(c)) % 65521, b = (b + a) % 65521;
  const auto size = static_cast<unsigned>(raw.size());
  std::string packed = "\x78\x01\x01";
  for (const unsigned n : {size, ~size}) {
    packed += static_cast<char>(n & 0xff);
    packed += static_cast<char>(n >> 8 & 0xff);
  }
  packed += raw + BigEndian(b << 16 | a);
  return "\x89PNG\r\n\x1a\n" +
         Chunk("IHDR" + BigEndian(columns) + BigEndian(rows) + static_cast<char>(bits) +
               static_cast<char>(colour) + std::string(3, '\0')) +
         Chunk("IDAT" + packed) + Chunk("IEND");
}

TEST_F(GroundText, HeightsComeFromImages) {
  // 3 x 2 samples of 16 bits: 0, 65535, 32768 above 1, 2, 256
  Write("hills.png", Png(3, 2, 16, 0, std::string("\0\0\xff\xff\x80\0\0\1\0\2\1\0", 12)));
  Diagnostics out;
  const auto experiment =
      Load("- {name: hills, height_field: {file: hills.png, cell_m: 0.1, height_range_m: [-1, 2]}}",
           out);
  ASSERT_TRUE(experiment) << out.Format();
  EXPECT_EQ(out.Format(), "");
  const HeightFieldDef& field = experiment->robot.def.height_fields[0];
  EXPECT_EQ(field.columns, 3);
  EXPECT_EQ(field.rows, 2);
  const double samples[] = {1, 2, 256, 0, 65535, 32768};  // the lowest row first
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(field.height_m[i], -1 + 3 * samples[i] / 65535, 1e-15) << i;
  }
}

TEST_F(GroundText, ImagesOfEightBitsMakeStepsAndSaySo) {
  Write("hills.png", Png(2, 2, 8, 0, std::string("\0\x33\xff\x66", 4)));
  Diagnostics out;
  const auto experiment = Load(
      "- {name: hills, height_field: {file: hills.png, cell_m: 0.1, height_range_m: [0, 5.1]}}",
      out);
  ASSERT_TRUE(experiment) << out.Format();
  EXPECT_NE(out.Format().find("hills.png: warning: the image has 8 bits per sample, so heights "
                              "have steps of 0.02 m (use 16 bits for smooth slopes)"),
            std::string::npos)
      << out.Format();
  const std::vector<double>& z = experiment->robot.def.height_fields[0].height_m;
  EXPECT_NEAR(z[0], 5.1, 1e-12);
  EXPECT_NEAR(z[1], 2.04, 1e-12);
  EXPECT_NEAR(z[2], 0, 1e-12);
  EXPECT_NEAR(z[3], 1.02, 1e-12);
}

TEST_F(GroundText, WrongImagesAreNamed) {
  const auto said = [&](const std::string& keys) {
    return Said("- {name: hills, height_field: {file: hills.png, cell_m: 0.1" + keys + "}}");
  };
  const auto has = [](const std::string& text, const std::string& what) {
    EXPECT_NE(text.find(what), std::string::npos) << text;
  };
  const std::string range = ", height_range_m: [0, 1]";
  has(said(range), "hills.png: error: cannot open");
  Write("hills.png", "no image at all, but long enough to be one");
  has(said(range), "hills.png: error: the image is not a PNG or is damaged: ");
  Write("hills.png", Png(2, 2, 8, 2, std::string(12, 'x')));
  has(said(range),
      "hills.png: error: the image has colors, but heights must be shades of gray (save it as "
      "grayscale with 16 bits)");
  Write("hills.png", Png(2, 2, 16, 0, std::string(8, 'x')));
  has(said(""), "height_field needs the key \"height_range_m\"");
  Write("hills.png", Png(2, 2, 16, 0, std::string(8, 'x')).substr(0, 50));
  has(said(range), "hills.png: error: the image is damaged: the data end too early");
  std::string spoilt = Png(2, 2, 16, 0, std::string(8, 'x'));
  spoilt[60] = static_cast<char>(spoilt[60] ^ 1);
  Write("hills.png", spoilt);
  has(said(range), "hills.png: error: the image is damaged: ");
  Write("hills.png", Png(2, 1, 16, 0, std::string(4, 'x')));
  has(said(range), "hills.png: error: the file must have at least two rows");
  Write("field.csv", "1,2\n3,4\n");
  has(Said("- {name: hills, height_field: {file: field.csv, cell_m: 1, height_range_m: [0, 1]}}"),
      "height_field.height_range_m has no effect here (it sets the heights of black and white in a "
      ".png image)");
}

// --- HDF5 ---------------------------------------------------------------------------------------

template <class T>
void WriteHdf5(const std::string& path, hid_t type, const std::vector<hsize_t>& size,
               const std::vector<T>& values) {
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hid_t space = H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr);
  const hid_t set = H5Dcreate2(file, "z", type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  H5Dclose(set), H5Sclose(space), H5Fclose(file);
}

TEST_F(GroundText, HeightsComeFromHdf5) {
  const std::string text = "- {name: hills, height_field: {file: 'hills.h5:/z', cell_m: 0.1}}";
  WriteHdf5(Path("hills.h5"), H5T_NATIVE_FLOAT, {2, 3},
            std::vector<float>{0, 1, 2, 3, 4.5F, -0.25F});
  const RobotSpec robot = With(text);
  EXPECT_EQ(robot.def.height_fields[0].columns, 3);
  EXPECT_EQ(robot.def.height_fields[0].rows, 2);
  EXPECT_EQ(robot.def.height_fields[0].height_m, (std::vector<double>{0, 1, 2, 3, 4.5, -0.25}));
  WriteHdf5(Path("hills.h5"), H5T_NATIVE_SHORT, {2, 2}, std::vector<short>{-3, 1, 2, 30000});
  EXPECT_EQ(With(text).def.height_fields[0].height_m, (std::vector<double>{-3, 1, 2, 30000}));
}

TEST_F(GroundText, WrongTablesOfHdf5AreNamed) {
  const auto said = [&](const std::string& file) {
    return Said("- {name: hills, height_field: {file: '" + file + "', cell_m: 0.1}}");
  };
  const auto has = [](const std::string& text, const std::string& what) {
    EXPECT_NE(text.find(what), std::string::npos) << text;
  };
  has(said("hills.h5:/z"), "hills.h5: error: cannot open");
  Write("hills.h5", "not at all");
  has(said("hills.h5:/z"), "hills.h5: error: the file is not HDF5 or is damaged: ");
  WriteHdf5(Path("hills.h5"), H5T_NATIVE_DOUBLE, {2, 3}, std::vector<double>{0, 1, 2, 3, 4, NAN});
  has(said("hills.h5"),
      "height_field.file needs the name of a data set (add it after a colon: hills.h5:/z)");
  has(said("hills.h5:/y"), "hills.h5: error: the file has no dataset /y");
  has(said("hills.h5:/z"), "hills.h5: error: /z: row 1, column 2 is not a finite number");
  WriteHdf5(Path("hills.h5"), H5T_NATIVE_DOUBLE, {6}, std::vector<double>(6));
  has(said("hills.h5:/z"), "hills.h5: error: /z has 1 dimensions instead of 2");
  WriteHdf5(Path("hills.h5"), H5T_NATIVE_DOUBLE, {1, 6}, std::vector<double>(6));
  has(said("hills.h5:/z"), "hills.h5: error: the file must have at least two rows");
  WriteHdf5(Path("hills.h5"), H5T_C_S1, {2, 2}, std::vector<char>(4));
  has(said("hills.h5:/z"), "hills.h5: error: /z contains no numbers");
}

/// Ways in which dataset /z of hills.h5 refers to another file
enum class Elsewhere { kExternalFile, kVirtual, kExternalLink, kSoftLink };
void WriteElsewhere(const std::string& path, const std::string& other, Elsewhere how) {
  const hsize_t size[2] = {2, 4};
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hid_t space = H5Screate_simple(2, size, nullptr);
  const hid_t plan = H5Pcreate(H5P_DATASET_CREATE);
  if (how == Elsewhere::kExternalLink) {
    H5Lcreate_external(other.c_str(), "/z", file, "z", H5P_DEFAULT, H5P_DEFAULT);
  } else if (how == Elsewhere::kSoftLink) {
    H5Lcreate_soft("/far", file, "z", H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_external(other.c_str(), "/z", file, "far", H5P_DEFAULT, H5P_DEFAULT);
  } else {
    if (how == Elsewhere::kExternalFile) {
      H5Pset_external(plan, other.c_str(), 0, 8);
    } else {
      H5Pset_virtual(plan, space, other.c_str(), "/z", space);
    }
    const hid_t set =
        H5Dcreate2(file, "z", H5T_NATIVE_UCHAR, space, H5P_DEFAULT, plan, H5P_DEFAULT);
    H5Dclose(set);
  }
  H5Pclose(plan), H5Sclose(space), H5Fclose(file);
}

TEST_F(GroundText, HeightsOfOtherFilesAreNotRead) {
  const auto said = [&] {
    return Said("- {name: hills, height_field: {file: 'hills.h5:/z', cell_m: 0.1}}");
  };
  const auto has = [](const std::string& text, const std::string& what) {
    EXPECT_NE(text.find(what), std::string::npos) << text;
  };
  Write("secret", "root:x:0");
  WriteHdf5(Path("other.h5"), H5T_NATIVE_UCHAR, {2, 4}, std::vector<unsigned char>(8, 1));
  WriteElsewhere(Path("hills.h5"), Path("secret"), Elsewhere::kExternalFile);
  has(said(), "hills.h5: error: /z stores its numbers in another file");
  WriteElsewhere(Path("hills.h5"), Path("other.h5"), Elsewhere::kVirtual);
  has(said(), "hills.h5: error: /z is a virtual dataset");
  WriteElsewhere(Path("hills.h5"), Path("other.h5"), Elsewhere::kExternalLink);
  has(said(), "hills.h5: error: /z is a link to another file");
  WriteElsewhere(Path("hills.h5"), Path("other.h5"), Elsewhere::kSoftLink);
  has(said(), "hills.h5: error: /z is a soft link; name the dataset itself");
}

TEST_F(GroundText, HeightsThatUnpackToGigabytesAreRefused) {
  // 8 000 x 8 000 numbers, none of which is stored in the file.
  const hsize_t size[2] = {8000, 8000};
  const hid_t file = H5Fcreate(Path("hills.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hid_t space = H5Screate_simple(2, size, nullptr);
  const hid_t set =
      H5Dcreate2(file, "z", H5T_NATIVE_UCHAR, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  H5Dclose(set), H5Sclose(space), H5Fclose(file);
  const std::string text =
      Said("- {name: hills, height_field: {file: 'hills.h5:/z', cell_m: 0.1}}");
  EXPECT_NE(text.find("hills.h5: error: the file has too high a compression ratio"),
            std::string::npos)
      << text;
}

}  // namespace
}  // namespace taut::test
