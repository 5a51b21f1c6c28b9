#include "apps/virtual_robot/avr_program.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string_view>

#include "base/input_file.h"

namespace taut::virtual_robot {
namespace {

// Executable and Linkable Format, 32 bits, according to the System V ABI; offsets into its
// structures.
constexpr std::size_t kMostBytes = 8U << 20U;
constexpr int kMachineAvr = 83;
constexpr std::uint32_t kLoad = 1, kSymbolTable = 2;
// Virtual addresses at which avr-gcc's linker places the chip's memories.
constexpr std::uint32_t kEepromBase = 0x81'0000, kMemoryBase = 0x80'0000;

/// Little-endian numbers of a file; 0 beyond its end.
class Image {
 public:
  explicit Image(const std::string& bytes) : bytes_(bytes) {}
  std::uint32_t At(std::size_t offset, int size) const {
    std::uint32_t value = 0;
    for (int i = 0; i < size; ++i) {
      const std::size_t at = offset + static_cast<std::size_t>(i);
      if (at < bytes_.size())
        value |= std::uint32_t{static_cast<unsigned char>(bytes_[at])} << 8 * i;
    }
    return value;
  }
  bool Has(std::size_t offset, std::size_t size) const {
    return offset <= bytes_.size() && size <= bytes_.size() - offset;
  }
  std::vector<std::uint8_t> Copy(std::size_t offset, std::size_t size) const {
    const auto first = bytes_.begin() + static_cast<std::ptrdiff_t>(offset);
    return {first, first + static_cast<std::ptrdiff_t>(size)};
  }
  std::string_view Text(std::size_t offset) const {
    if (offset >= bytes_.size()) return {};
    const std::string_view rest = std::string_view(bytes_).substr(offset);
    return rest.substr(0, rest.find('\0'));
  }

 private:
  const std::string& bytes_;
};

/// Copies a segment to its address. Returns false if it does not fit.
bool Place(const std::vector<std::uint8_t>& bytes, std::size_t at, std::size_t size,
           std::vector<std::uint8_t>& memory) {
  if (at + bytes.size() > size) return false;
  if (memory.size() < at + bytes.size()) memory.resize(at + bytes.size(), 0xFF);
  std::copy(bytes.begin(), bytes.end(), memory.begin() + static_cast<std::ptrdiff_t>(at));
  return true;
}

/// Returns the address of a symbol; nothing if it does not exist.
std::optional<std::uint32_t> FindSymbol(const Image& image, std::string_view name) {
  const std::uint32_t sections = image.At(32, 4), entry = image.At(46, 2), count = image.At(48, 2);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::size_t section = sections + std::size_t{i} * entry;
    if (image.At(section + 4, 4) != kSymbolTable) continue;
    const std::uint32_t offset = image.At(section + 16, 4), size = image.At(section + 20, 4);
    const std::size_t texts = sections + std::size_t{image.At(section + 24, 4)} * entry;
    const std::uint32_t text_offset = image.At(texts + 16, 4);
    if (!image.Has(offset, size)) continue;
    for (std::size_t at = offset; at + 16 <= std::size_t{offset} + size; at += 16) {
      if (image.Text(std::size_t{text_offset} + image.At(at, 4)) == name)
        return image.At(at + 4, 4);
    }
  }
  return std::nullopt;
}

}  // namespace

std::shared_ptr<const AvrProgram> ReadAvrProgram(const std::string& path, Diagnostics& out) {
  const auto bytes =
      base::ReadInputFile(path, kMostBytes, "expected a program for an ATmega328P", out);
  if (!bytes) return nullptr;
  const auto refuse = [&](std::string what, std::string hint) {
    out.Error("firmware.not_readable", {path}, std::move(what), std::move(hint));
    return nullptr;
  };
  const Image image(*bytes);
  const std::string hint = "expected the .elf file linked by avr-gcc -mmcu=atmega328p";
  if (bytes->substr(0, 4) != "\177ELF") return refuse("the firmware is not an ELF file", hint);
  if (image.At(4, 1) != 1 || image.At(18, 2) != kMachineAvr) {
    return refuse("the firmware is an ELF file for another machine than AVR", hint);
  }
  if (image.At(16, 2) != 2) return refuse("the firmware is not a linked program", hint);
  auto program = std::make_shared<AvrProgram>();
  const std::uint32_t headers = image.At(28, 4), entry = image.At(42, 2), count = image.At(44, 2);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::size_t header = headers + std::size_t{i} * entry;
    const std::uint32_t offset = image.At(header + 4, 4), load_at = image.At(header + 12, 4),
                        size = image.At(header + 16, 4);
    if (image.At(header, 4) != kLoad || size == 0) continue;
    if (!image.Has(offset, size)) return refuse("the firmware is truncated", "copy the file again");
    const std::vector<std::uint8_t> segment = image.Copy(offset, size);
    if (load_at < kMemoryBase) {
      // Two bytes are reserved for the emulator's endless loop.
      if (!Place(segment, load_at, AvrProgram::kFlashBytes - 2, program->flash)) {
        return refuse("the firmware does not fit into 32 kB of flash", "");
      }
    } else if (load_at >= kEepromBase && load_at < kEepromBase + 0x1'0000 &&
               !Place(segment, load_at - kEepromBase, AvrProgram::kEepromBytes, program->eeprom)) {
      return refuse("the firmware does not fit into 1 kB of EEPROM", "");
    }
  }
  if (program->flash.empty()) return refuse("the firmware contains no program", hint);
  const auto end = FindSymbol(image, "_end");
  if (!end)
    return refuse("the firmware has no symbol _end, the end of its variables",
                  "do not strip the symbols");
  program->free_memory = *end - kMemoryBase;
  if (program->free_memory < AvrProgram::kMemoryStart ||
      program->free_memory > AvrProgram::kMemoryEnd) {
    return refuse("the variables of the firmware do not fit into 2 kB of memory", "");
  }
  return program;
}

}  // namespace taut::virtual_robot
