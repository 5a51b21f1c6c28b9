/// CRC-8 and CRC-16 checksums of messages and of the EEPROM.
#pragma once

#include <stddef.h>
#include <stdint.h>

namespace taut {
namespace board {
namespace internal {

/// Tables for half bytes with 16 entries. Tables for bytes would need 256 entries each in the RAM
/// of an AVR.
constexpr uint16_t kCrc16[16] = {0x0000, 0x1021, 0x2042, 0x3063, 0x4084, 0x50a5, 0x60c6, 0x70e7,
                                 0x8108, 0x9129, 0xa14a, 0xb16b, 0xc18c, 0xd1ad, 0xe1ce, 0xf1ef};
constexpr uint8_t kCrc8[16] = {0x00, 0x07, 0x0e, 0x09, 0x1c, 0x1b, 0x12, 0x15,
                               0x38, 0x3f, 0x36, 0x31, 0x24, 0x23, 0x2a, 0x2d};

}  // namespace internal

constexpr uint16_t kCrc16Start = 0xffff;
constexpr uint8_t kCrc8Start = 0;

/// Returns a CRC-16/CCITT-FALSE extended by one byte. Polynomial 0x1021, start 0xffff, not
/// reflected; check value 0x29b1 for "123456789".
constexpr uint16_t AddToCrc16(uint16_t crc, uint8_t byte) noexcept {
  crc = static_cast<uint16_t>(static_cast<uint16_t>(crc << 4) ^
                              internal::kCrc16[(crc >> 12) ^ (byte >> 4)]);
  return static_cast<uint16_t>(static_cast<uint16_t>(crc << 4) ^
                               internal::kCrc16[(crc >> 12) ^ (byte & 0x0f)]);
}

/// Returns a CRC-8 extended by one byte. Polynomial 0x07, start 0, not reflected; check value 0xf4
/// for "123456789".
constexpr uint8_t AddToCrc8(uint8_t crc, uint8_t byte) noexcept {
  crc = static_cast<uint8_t>(crc ^ byte);
  crc = static_cast<uint8_t>(static_cast<uint8_t>(crc << 4) ^ internal::kCrc8[crc >> 4]);
  return static_cast<uint8_t>(static_cast<uint8_t>(crc << 4) ^ internal::kCrc8[crc >> 4]);
}

/// Returns the CRC-16 of `count` bytes; `crc` is the checksum of the bytes before them.
constexpr uint16_t Crc16(const uint8_t* bytes, size_t count, uint16_t crc = kCrc16Start) noexcept {
  for (size_t i = 0; i < count; ++i) crc = AddToCrc16(crc, bytes[i]);
  return crc;
}

/// Returns the CRC-8 of `count` bytes; `crc` is the checksum of the bytes before them.
constexpr uint8_t Crc8(const uint8_t* bytes, size_t count, uint8_t crc = kCrc8Start) noexcept {
  for (size_t i = 0; i < count; ++i) crc = AddToCrc8(crc, bytes[i]);
  return crc;
}

}  // namespace board
}  // namespace taut
