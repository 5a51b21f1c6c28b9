/// ELF program for an ATmega328P, linked by avr-gcc.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "taut/diagnostics.h"

namespace taut::virtual_robot {

struct AvrProgram {
  static constexpr std::uint32_t kFlashBytes = 32 * 1024;
  static constexpr std::uint32_t kMemoryStart = 0x100, kMemoryEnd = 0x900;
  static constexpr std::uint32_t kEepromBytes = 1024;

  std::vector<std::uint8_t> flash;   ///< Content from address 0; the rest of the flash is 0xFF.
  std::vector<std::uint8_t> eeprom;  ///< Content from address 0; empty if the file has no EEPROM
                                     ///< section.
  /// First address of memory above all variables: the stack may grow down to it.
  std::uint32_t free_memory = kMemoryStart;
};

/// Reads an ELF file of machine AVR. Returns null, with errors in `out`, for other files and for
/// programs that do not fit.
std::shared_ptr<const AvrProgram> ReadAvrProgram(const std::string& path, Diagnostics& out);

}  // namespace taut::virtual_robot
