#include "apps/firmware/board_memory.h"

#include <avr/eeprom.h>
#include <stddef.h>

#include "taut/board/crc.h"

using namespace taut::board;

namespace {

// EEPROM layout (docs/hardware/firmware.md); `identity` is written when the board is flashed.
struct Head {
  uint8_t identity;  // number of the board, 0 to 5
  uint8_t reserved;
  uint16_t nonce, not_nonce;
};
constexpr uint16_t kParametersAt = 8;  // version, parameters, checksum over both
constexpr uint8_t kNobody = 7;         // number of a board without identity: its address is 0x17

constexpr uint16_t kRecordSize = sizeof(Parameters) + 4;
uint16_t store_at;
uint16_t store_crc;

uint8_t* EepromByte(uint16_t at) { return reinterpret_cast<uint8_t*>(at); }

enum class Found : uint8_t { kGood, kNothing, kBroken };

Found LoadParameters(Parameters& parameters) {
  uint8_t* const bytes = reinterpret_cast<uint8_t*>(&parameters);
  uint16_t crc = kCrc16Start, version = 0, stored = 0;
  bool blank = true;
  for (uint16_t i = 0; i < kRecordSize; ++i) {
    const uint8_t byte = eeprom_read_byte(EepromByte(kParametersAt + i));
    if (byte != 0xff) blank = false;
    if (i < 2) {
      version |= static_cast<uint16_t>(byte << (8 * i));
    } else if (i < kRecordSize - 2) {
      bytes[i - 2] = byte;
    } else {
      stored |= static_cast<uint16_t>(byte << (8 * (i - (kRecordSize - 2))));
    }
    if (i < kRecordSize - 2) crc = AddToCrc16(crc, byte);
  }
  if (crc == stored && version == kParametersVersion) return Found::kGood;
  SetDefaults(parameters);
  return blank ? Found::kNothing : Found::kBroken;
}

}  // namespace

Boot ReadMemory(Parameters& parameters) {
  Head head;
  eeprom_read_block(&head, nullptr, sizeof head);
  Boot boot;
  boot.board = head.identity < kBoards ? head.identity : kNobody;
  boot.nonce = head.nonce == static_cast<uint16_t>(~head.not_nonce)
                   ? static_cast<uint16_t>(head.nonce + 1)
                   : uint16_t{1};
  head.nonce = boot.nonce;
  head.not_nonce = static_cast<uint16_t>(~boot.nonce);
  eeprom_update_block(&head.nonce, EepromByte(offsetof(Head, nonce)), 4);
  boot.parameters_good = LoadParameters(parameters) != Found::kBroken;
  return boot;
}

void StepMemory(Board& board) {
  if (board.memory == Memory::kIdle || !eeprom_is_ready()) return;
  if (board.memory == Memory::kLoad) {
    if (LoadParameters(board.parameters) == Found::kBroken) board.board_faults |= kParametersLost;
    Prepare(board);
    board.memory = Memory::kIdle;
    return;
  }
  if (store_at == 0) store_crc = kCrc16Start;
  uint8_t byte = 0;
  if (store_at < 2) {
    byte = static_cast<uint8_t>(kParametersVersion >> (8 * store_at));
  } else if (store_at < kRecordSize - 2) {
    byte = reinterpret_cast<const uint8_t*>(&board.parameters)[store_at - 2];
  } else {
    byte = static_cast<uint8_t>(store_crc >> (8 * (store_at - (kRecordSize - 2))));
  }
  if (store_at < kRecordSize - 2) store_crc = AddToCrc16(store_crc, byte);
  eeprom_update_byte(EepromByte(kParametersAt + store_at), byte);
  if (++store_at < kRecordSize) return;
  store_at = 0;
  board.memory = Memory::kIdle;
}
