/// A program for an ATmega328P, as avr-gcc links it.
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

  std::vector<std::uint8_t> flash;   ///< From address 0; the rest of the chip's is 0xFF.
  std::vector<std::uint8_t> eeprom;  ///< From address 0; empty if the file says nothing.
  /// The first address of the memory that no variable has: above it the stack may grow.
  std::uint32_t free_memory = kMemoryStart;
};

/// Reads an ELF file of machine AVR. Nothing, and complaints, if it is none or does not fit.
std::shared_ptr<const AvrProgram> ReadAvrProgram(const std::string& path, Diagnostics& out);

}  // namespace taut::virtual_robot
