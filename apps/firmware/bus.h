// I2C slave of a motor board, with general call (broadcast).
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "taut/board/protocol.h"

struct Message {
  // One byte more than the longest valid message, so that a longer one is detected.
  uint8_t bytes[taut::board::kMaxMessageSize + 1];
  uint8_t size;
  bool to_all;
};

void StartBus(uint8_t address);
// Returns the oldest waiting message; null if there is none. Release it with `DropMessage`.
const Message* NextMessage();
void DropMessage();
// Returns the number of messages lost for lack of a buffer since the last call.
uint8_t TakeLost();

// Sets the frame for the next read; a read in progress continues with its frame. Returns false, and
// publishes nothing, while a read is in progress that began two frames ago.
bool Publish(const uint8_t (&frame)[taut::board::kFrameSize], bool is_reply);
// Returns whether the published reply has been read.
bool ReplyWasRead();

// To be called every tick. Returns true if the bus hung in the middle of a transfer and was
// restarted.
bool RecoverBus();
