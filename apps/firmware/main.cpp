// Firmware of a motor board: hardware layer and main loop for an ATmega328P at 16 MHz (Arduino
// Nano). The hardware-independent logic is in include/taut/board.
#include <avr/interrupt.h>
#include <avr/sleep.h>
#include <avr/wdt.h>
#include <util/atomic.h>

#include "apps/firmware/board_memory.h"
#include "apps/firmware/board_sensors.h"
#include "apps/firmware/bus.h"
#include "apps/firmware/drive.h"
#include "apps/firmware/pins.h"
#include "taut/board/board.h"

using namespace taut::board;

// Global so that emulators and debuggers can read them; only the main loop accesses them.
Board board;
Inputs inputs;

namespace {

volatile uint8_t ticks_due;
bool asked_anew;  // a request after the last publication may have changed the reply
uint8_t reset_cause __attribute__((section(".noinit")));

// After a watchdog reset, the watchdog stays on with a timeout shorter than the initialization of
// memory. It is therefore disabled in .init3.
void KeepCause() __attribute__((naked, used, section(".init3")));
void KeepCause() {
  reset_cause = MCUSR;
  MCUSR = 0;
  wdt_disable();
}

void StartClock() {
  TCCR2A = 1 << WGM21;
  TCCR2B = 1 << CS22;  // timer clock: 250 kHz
  OCR2A = 249;
  TIFR2 = 1 << OCF2A;
  TIMSK2 = 1 << OCIE2A;
}

uint8_t TakeTicks() {
  uint8_t count = 0;
  ATOMIC_BLOCK(ATOMIC_FORCEON) {
    count = ticks_due;
    ticks_due = 0;
  }
  return count;
}

void RunTick(uint8_t elapsed) {
  GPIOR0 = kMarkTick | static_cast<uint8_t>(board.mode);
  inputs.elapsed = elapsed;
  inputs.driver_fault = DriverSaysFault();
  for (uint8_t m = 0; m < kMotors; ++m) {
    inputs.adc[m] = LoadCell(m);
    inputs.encoder[m] = Encoder(m);
  }
  Tick(inputs, board);
  for (uint8_t m = 0; m < kMotors; ++m) SetWidth(m, board.loops[m].width);
  SetPower(IsPowered(board));
  // loop time in units of 8 us: half of the timer's count since the tick was due (4 us each), plus
  // 125 if the next tick is already due
  const uint8_t eighths =
      ticks_due == 0 ? static_cast<uint8_t>(TCNT2 / 2) : static_cast<uint8_t>(125 + TCNT2 / 2);
  if (eighths > board.longest_tick_8us) board.longest_tick_8us = eighths;
  GPIOR0 = kMarkTickDone | static_cast<uint8_t>(board.mode);
}

// Publishes the reply, or else the status. A reply stays until it has been read; then statuses
// follow.
void PublishFrame() {
  static bool reply_is_out = false;
  if (reply_is_out && ReplyWasRead()) {
    reply_is_out = board.reply_due = false;
    board.status_due = true;
  }
  const bool reply = board.reply_due;
  if (reply ? reply_is_out && !asked_anew : !board.status_due) return;
  uint8_t frame[kFrameSize];
  MakeFrame(board, frame);
  if (!Publish(frame, reply)) return;  // retried at the next tick
  reply_is_out = reply;
  if (reply) {
    asked_anew = false;
  } else {
    board.status_due = false;
  }
}

}  // namespace

ISR(TIMER2_COMPA_vect) {
  StartConversions();
  ticks_due = ticks_due + 1;
}

int main() {
  Boot boot = ReadMemory(board.parameters);
  boot.reset_cause = reset_cause;
  Start(boot, board);
  StartDrive();
  StartSensors();
  StartBus(BoardAddress(boot.board));
  board.status_due = true;
  PublishFrame();
  StartClock();
  wdt_enable(WDTO_60MS);
  set_sleep_mode(SLEEP_MODE_IDLE);
  sei();
  for (;;) {
    const uint8_t elapsed = TakeTicks();
    if (elapsed > 0) {
      RunTick(elapsed);
      wdt_reset();
      Feel(board);
      if (ticks_due == 0 && !board.status_due && NextMessage() == nullptr) DoSlowWork(board);
      if (RecoverBus()) {
        internal::Count(board.counters.recoveries);
        board.board_faults |= kBusStuck;
      }
      for (uint8_t lost = TakeLost(); lost > 0; --lost)
        internal::Count(board.counters.bad_messages);
      StepMemory(board);
      PublishFrame();
      GPIOR0 = kMarkIdle;
    }
    if (const Message* const message = NextMessage()) {
      GPIOR0 = kMarkMessage;
      Receive(message->bytes, message->size, message->to_all, board);
      if (!message->to_all) asked_anew = board.reply_due;
      DropMessage();
    }
    PublishFrame();
    // Sleeps unless a tick or a message arrived in the meantime; the instruction after sei runs
    // before any interrupt.
    cli();
    if (ticks_due == 0 && NextMessage() == nullptr) {
      sleep_enable();
      sei();
      sleep_cpu();
      sleep_disable();
    }
    sei();
  }
}
