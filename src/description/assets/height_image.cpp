#include "description/assets/height_image.h"

#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>
#include <string_view>

#include "base/input_file.h"

namespace taut::description {
namespace {

constexpr std::size_t kMostImageBytes = std::size_t{1} << 30;

/// Input bytes and error message of libpng.
struct Source {
  std::string_view bytes;
  std::size_t at = 0;
  char why[200] = "";
  std::jmp_buf back;
};

[[noreturn]] void Fail(png_structp png, png_const_charp why) {
  Source& source = *static_cast<Source*>(png_get_error_ptr(png));
  std::strncpy(source.why, why, sizeof source.why - 1);
  std::longjmp(source.back, 1);
}
void Ignore(png_structp, png_const_charp) {}
void Take(png_structp png, png_bytep to, std::size_t count) {
  Source& source = *static_cast<Source*>(png_get_io_ptr(png));
  if (count > source.bytes.size() - source.at) Fail(png, "the data end too early");
  std::memcpy(to, source.bytes.data() + source.at, count);
  source.at += count;
}

struct PngHeader {
  png_uint_32 columns = 0, rows = 0;
  int bits = 0, colour = 0;
};

/// Reader of one image. libpng reports errors by longjmp, which skips destructors. So functions
/// that call libpng must not contain objects with destructors.
class Reader {
 public:
  explicit Reader(std::string_view bytes) {
    source_.bytes = bytes;
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, &source_, Fail, Ignore);
    if (png_ != nullptr) info_ = png_create_info_struct(png_);
  }
  ~Reader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  bool ReadHead(PngHeader& head) {
    if (info_ == nullptr || setjmp(source_.back) != 0) return false;
    png_set_read_fn(png_, &source_, Take);
    png_read_info(png_, info_);
    png_get_IHDR(png_, info_, &head.columns, &head.rows, &head.bits, &head.colour, nullptr, nullptr,
                 nullptr);
    return true;
  }
  /// Reads rows of 1 or 2 bytes per sample, most significant byte first.
  bool ReadRows(png_bytepp rows) {
    if (setjmp(source_.back) != 0) return false;
    png_set_expand_gray_1_2_4_to_8(png_);
    png_set_strip_alpha(png_);
    png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    png_read_image(png_, rows);
    png_read_end(png_, nullptr);
    return true;
  }
  const char* why() const { return source_.why; }

 private:
  Source source_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};

}  // namespace

std::optional<HeightImage> ReadHeightImage(const std::string& path, trace::TableBudget& budget,
                                           Diagnostics& out) {
  const auto bytes = base::ReadInputFile(path, kMostImageBytes, "use fewer, larger cells", out);
  if (!bytes) return std::nullopt;
  const auto refuse = [&](const std::string& what, const std::string& hint = {}) {
    out.Error("heights.bad_image", {path, 0, 0}, what, hint);
    return std::nullopt;
  };
  Reader reader(*bytes);
  PngHeader head;
  if (!reader.ReadHead(head)) {
    return refuse(std::string("the image is not a PNG or is damaged: ") + reader.why(),
                  "expected a grayscale PNG, preferably with 16 bits");
  }
  if ((head.colour & PNG_COLOR_MASK_COLOR) != 0) {
    return refuse("the image has colors, but heights must be shades of gray",
                  "save it as grayscale with 16 bits");
  }
  const double samples = static_cast<double>(head.columns) * head.rows;
  if (samples > budget.left()) {
    return refuse("the image has " + std::to_string(head.columns) + " x " +
                      std::to_string(head.rows) + " samples" + budget.MoreThan(),
                  "use fewer, larger cells");
  }
  const auto file_bytes = static_cast<double>(bytes->size());
  if (!budget.Unpacks(sizeof(double) * samples, file_bytes)) {
    return refuse("the image has too high a compression ratio: " + std::to_string(head.columns) +
                      " x " + std::to_string(head.rows) + " samples from " +
                      std::to_string(bytes->size()) + " bytes unpack to " +
                      budget.UnpackedMoreThan(),
                  "use fewer, larger cells, or save it without compression");
  }
  budget.AddPacked(samples, file_bytes);
  const std::size_t width = head.bits == 16 ? 2 : 1, columns = head.columns, rows = head.rows;
  std::vector<png_byte> samples_of(width * columns * rows);
  std::vector<png_bytep> row_starts;
  for (std::size_t j = 0; j < rows; ++j) {
    row_starts.push_back(samples_of.data() + width * columns * j);
  }
  if (!reader.ReadRows(row_starts.data())) {
    return refuse(std::string("the image is damaged: ") + reader.why());
  }
  HeightImage image{static_cast<int>(columns), static_cast<int>(rows), head.bits, {}};
  image.shares.reserve(columns * rows);
  for (std::size_t j = rows; j-- > 0;) {
    const png_byte* sample = row_starts[j];
    for (std::size_t i = 0; i < columns; ++i, sample += width) {
      image.shares.push_back(width == 2 ? (256.0 * sample[0] + sample[1]) / 65535.0
                                        : sample[0] / 255.0);
    }
  }
  return image;
}

}  // namespace taut::description
