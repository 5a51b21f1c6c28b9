#include "apps/firmware/bus.h"

#include <avr/interrupt.h>
#include <string.h>
#include <util/atomic.h>
#include <util/twi.h>

using taut::board::kFrameSize;
using taut::board::kMaxMessageSize;

namespace {

constexpr uint8_t kListen = 1 << TWINT | 1 << TWEA | 1 << TWEN | 1 << TWIE;
constexpr uint8_t kLongestTransferTicks = 25;

// Two message buffers; the interrupt fills `inbox[filling]`.
Message inbox[2];
volatile uint8_t filling, waiting;  // `waiting`: number of full buffers, 0 to 2
volatile uint8_t lost;
volatile bool fill_to_all;
// Address of the next byte, and the number of bytes that still fit. With a pointer instead of an
// index the interrupt takes 20 cycles less; a broadcast delays the ticks of all boards by this
// interrupt.
uint8_t* volatile fill_at;
volatile uint8_t fill_room;
volatile bool dropping;

uint8_t frames[2][kFrameSize];
volatile uint8_t published, sending, sent;
volatile bool reply_published, reply_read;

volatile bool in_transfer;
uint8_t own_address, transfer_ticks;

void Begin(bool to_all) {
  fill_to_all = to_all;
  dropping = waiting == 2;
  fill_at = inbox[filling].bytes;
  fill_room = dropping ? 0 : sizeof inbox[0].bytes;
}

void Finish() {
  if (dropping) {
    lost = lost + 1;
    return;
  }
  Message& message = inbox[filling];
  message.size = static_cast<uint8_t>(sizeof message.bytes - fill_room);
  message.to_all = fill_to_all;
  filling = filling ^ 1;
  waiting = waiting + 1;
}

}  // namespace

// The interrupt must be short: SCL stays low while it runs, which blocks the bus of all six boards.
ISR(TWI_vect) {
  const uint8_t status = TWSR & TW_NO_INFO;
  if (status == TW_SR_GCALL_DATA_ACK || status == TW_SR_DATA_ACK) {  // the most frequent case
    const uint8_t byte = TWDR;
    const uint8_t room = fill_room;
    if (room != 0) {
      uint8_t* const at = fill_at;
      *at = byte;
      fill_at = at + 1;
      fill_room = room - 1;
    }
    TWCR = kListen;
    return;
  }
  switch (status) {
    case TW_ST_DATA_ACK:
      TWDR = sent < kFrameSize ? frames[sending][sent] : 0xff;
      sent = sent + 1;
      break;
    case TW_SR_SLA_ACK:
    case TW_SR_GCALL_ACK:
      Begin(status == TW_SR_GCALL_ACK);
      in_transfer = true;
      break;
    case TW_ST_SLA_ACK:
      sending = published;
      TWDR = frames[sending][0];
      sent = 1;
      if (reply_published) reply_read = true;
      in_transfer = true;
      break;
    case TW_SR_STOP:
      if (in_transfer) Finish();
      in_transfer = false;
      break;
    case TW_BUS_ERROR:
      TWCR = kListen | 1 << TWSTO;
      in_transfer = false;
      return;
    default:  // end of a read, or a byte that was not acknowledged
      in_transfer = false;
  }
  TWCR = kListen;
}

void StartBus(uint8_t address) {
  own_address = address;
  in_transfer = false;
  TWAR = static_cast<uint8_t>(address << 1 | 1);  // lowest bit: answer the general call
  TWCR = kListen;
}

const Message* NextMessage() {
  if (waiting == 0) return nullptr;
  // the oldest: `filling` if both buffers are full, else the other one
  return &inbox[waiting == 2 ? filling : filling ^ 1];
}

void DropMessage() {
  ATOMIC_BLOCK(ATOMIC_FORCEON) { waiting = waiting - 1; }
}

uint8_t TakeLost() {
  uint8_t count = 0;
  ATOMIC_BLOCK(ATOMIC_FORCEON) {
    count = lost;
    lost = 0;
  }
  return count;
}

bool Publish(const uint8_t (&frame)[kFrameSize], bool is_reply) {
  // the frame that is not published; it can be in transmission only if it was published before
  const uint8_t next = published ^ 1;
  bool busy = false;
  ATOMIC_BLOCK(ATOMIC_FORCEON) { busy = in_transfer && sending == next && sent < kFrameSize; }
  if (busy) return false;
  memcpy(frames[next], frame, kFrameSize);
  ATOMIC_BLOCK(ATOMIC_FORCEON) {
    published = next;
    reply_published = is_reply;
    reply_read = false;
  }
  return true;
}

bool ReplyWasRead() { return reply_read; }

bool RecoverBus() {
  if (!in_transfer) {
    transfer_ticks = 0;
    return false;
  }
  if (++transfer_ticks < kLongestTransferTicks) return false;
  transfer_ticks = 0;
  TWCR = 0;
  StartBus(own_address);
  return true;
}
