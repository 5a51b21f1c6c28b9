// The board's side of the bus: an I2C slave that hears the general call.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "taut/board/protocol.h"

struct Message {
  // One more than a message may have: one that is too long is seen to be.
  uint8_t bytes[taut::board::kMaxMessageSize + 1];
  uint8_t size;
  bool to_all;
};

void StartBus(uint8_t address);
// The oldest message that waits; null: none. To be given back by `DropMessage`.
const Message* NextMessage();
void DropMessage();
// Messages that found no room since the last call.
uint8_t TakeLost();

// What the next read gets; a read under way goes on with what it began. False: not now, a read is
// under way that began two frames ago.
bool Publish(const uint8_t (&frame)[taut::board::kFrameSize], bool is_reply);
// Whether the reply that was published has been read.
bool ReplyWasRead();

// Every tick: true if the bus hung in the middle of a transfer and was begun anew.
bool RecoverBus();
