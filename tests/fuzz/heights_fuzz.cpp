// Fuzz target of gray PNG images as heights, with damage, or any bytes.
//
// Input: as for `Damaged`. Bases: images of 1 to 16 bits, plain, interlaced, with an alpha channel,
// with a palette. Inputs of odd size get correct checksums: libpng stops at a wrong one. For one
// input in 16, the image becomes ground of an experiment, onto which a rod falls.
#include <png.h>
#include <zlib.h>

#include "description/assets/height_image.h"
#include "fuzz/on_ground.h"

namespace {

using taut::fuzz::Folder;
using taut::fuzz::Must;

struct Kind {
  int bits, color, interlace;
};
constexpr Kind kKinds[] = {{16, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE},
                           {8, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_ADAM7},
                           {1, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE},
                           {4, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_ADAM7},
                           {16, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_INTERLACE_NONE},
                           {2, PNG_COLOR_TYPE_PALETTE, PNG_INTERLACE_NONE},
                           {8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE}};

std::string Image(const Kind& kind) {
  constexpr png_uint_32 kColumns = 11, kRows = 7;
  std::string file;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(
      png, &file,
      [](png_structp to, png_bytep bytes, std::size_t count) {
        static_cast<std::string*>(png_get_io_ptr(to))
            ->append(reinterpret_cast<const char*>(bytes), count);
      },
      [](png_structp) {});
  png_set_IHDR(png, info, kColumns, kRows, kind.bits, kind.color, kind.interlace,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  const png_color palette[4] = {{0, 0, 0}, {80, 80, 80}, {160, 160, 160}, {255, 255, 255}};
  if (kind.color == PNG_COLOR_TYPE_PALETTE) png_set_PLTE(png, info, palette, 4);
  png_set_gAMA(png, info, 0.45455);
  png_write_info(png, info);
  std::vector<std::vector<png_byte>> rows(kRows);
  std::vector<png_bytep> starts;
  for (std::size_t j = 0; j < kRows; ++j) {
    for (std::size_t i = 0; i < png_get_rowbytes(png, info); ++i) {
      rows[j].push_back(static_cast<png_byte>(37 * i * i + 91 * j));
    }
    starts.push_back(rows[j].data());
  }
  png_write_image(png, starts.data());
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return file;
}

std::vector<std::string> Images() {
  std::vector<std::string> images;
  for (const Kind& kind : kKinds) images.push_back(Image(kind));
  return images;
}

std::size_t BigEndian(const std::string& file, std::size_t at) {
  std::size_t value = 0;
  for (std::size_t k = 0; k < 4; ++k) value = value << 8 | static_cast<unsigned char>(file[at + k]);
  return value;
}

/// Sets the checksum of each chunk: length, kind, data, checksum.
void CorrectChecksums(std::string& file) {
  constexpr std::size_t kSignature = 8, kFrame = 12;
  for (std::size_t at = kSignature; at + kFrame <= file.size();) {
    const std::size_t length = BigEndian(file, at);
    if (length > file.size() - at - kFrame) return;
    const auto* const kind = reinterpret_cast<const Bytef*>(file.data() + at + 4);
    const std::size_t sum = crc32(0, kind, static_cast<uInt>(length + 4));
    at += kFrame + length;
    for (std::size_t k = 0; k < 4; ++k) file[at - 1 - k] = static_cast<char>(sum >> (8 * k) & 0xff);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Folder folder;
  static const std::vector<std::string> bases = Images();
  if (size == 0) return 0;
  std::string file = taut::fuzz::Damaged(bases, data, size);
  if (size % 2 == 1) CorrectChecksums(file);
  const std::string path = folder.Write("hills.png", file.data(), file.size());
  taut::Diagnostics of_image, out;
  taut::trace::TableBudget budget(1e8);
  const auto image = taut::description::ReadHeightImage(path, budget, of_image);
  taut::fuzz::CheckReading(image.has_value(), of_image);
  if (!image) return 0;
  Must(image->shares.size() ==
           static_cast<std::size_t>(image->columns) * static_cast<std::size_t>(image->rows),
       "a sample for each corner");
  for (const double share : image->shares) Must(share >= 0 && share <= 1, "a shade of gray");
  if (!taut::fuzz::OneIn(16, data, size)) return 0;
  const auto read = taut::fuzz::ReadTerrain(
      folder,
      "{name: g, height_field: {file: hills.png, cell_m: 0.1, height_range_m: [-0.5, 0.1]}}", out);
  if (!read) return 0;
  taut::ModelDef def = taut::fuzz::HeightsOf(*read);
  for (const double height_m : def.height_fields.at(0).height_m) {
    Must(height_m >= -0.5 - 1e-9 && height_m <= 0.1 + 1e-9, "a height within the range");
  }
  taut::fuzz::DropARod(std::move(def), 5);
  return 0;
}
