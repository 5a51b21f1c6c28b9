// Test program for a board that uses all of its peripherals and reports their data to tests. It is
// not a firmware: it executes orders, and switches the motors off after 100 ms without a message.
#include <avr/eeprom.h>
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>
#include <avr/wdt.h>

#include "mailbox.h"

namespace {

volatile uint8_t& Byte(uint16_t address) { return *reinterpret_cast<volatile uint8_t*>(address); }
volatile uint16_t& Word(uint16_t address) { return *reinterpret_cast<volatile uint16_t*>(address); }
volatile uint32_t& Long(uint16_t address) { return *reinterpret_cast<volatile uint32_t*>(address); }

constexpr uint8_t kFirstAddress = 0x10;
constexpr uint16_t kTop = 400;
constexpr uint8_t kLimitMilliseconds = 100;

uint8_t cause __attribute__((section(".noinit")));
volatile uint8_t position;  // in the message
volatile uint8_t channel;   // of the running conversion

void SetMotors(uint16_t a, uint16_t b, uint8_t winds_in, uint8_t enable) {
  OCR1A = a;
  OCR1B = b;
  PORTD = static_cast<uint8_t>((PORTD & ~(_BV(PD7) | _BV(PD6))) | ((winds_in & 1) ? _BV(PD7) : 0) |
                               (enable ? _BV(PD6) : 0));
  if (winds_in & 2) {
    PORTB |= _BV(PB0);
  } else {
    PORTB &= static_cast<uint8_t>(~_BV(PB0));
  }
}

uint16_t Width(int8_t duty) {
  const uint16_t size = static_cast<uint16_t>(duty < 0 ? -duty : duty);
  return static_cast<uint16_t>(size * kTop / 127);
}

/// Takes a broadcast: 0xC1, then a duty of -127..127 for each motor of the robot, then enable.
void TakeMessage() {
  const uint8_t count = Byte(kBoxReceivedCount);
  if (count < 14 || Byte(kBoxReceived) != 0xC1) return;
  Byte(kBoxMissed) = 0;
  const uint8_t first = static_cast<uint8_t>(1 + 2 * Byte(kBoxId));
  const int8_t a = static_cast<int8_t>(Byte(kBoxReceived + first));
  const int8_t b = static_cast<int8_t>(Byte(kBoxReceived + first + 1));
  SetMotors(Width(a), Width(b), static_cast<uint8_t>((a > 0 ? 1 : 0) | (b > 0 ? 2 : 0)),
            Byte(kBoxReceived + 13));
}

void Obey() {
  const uint8_t order = Byte(kBoxOrder);
  Byte(kBoxOrder) = kOrderNone;
  if (order == kOrderHang) {
    cli();
    for (;;) {
    }
  } else if (order == kOrderSleepForever) {
    cli();
    sleep_cpu();
  } else if (order == kOrderLeave) {
    asm volatile("ldi r30, 0xFF\n ldi r31, 0x7F\n ijmp\n");
  } else if (order == kOrderSetCauses) {
    MCUSR = 0x0F;
    Byte(kBoxCausesRead) = MCUSR;
  } else if (order == kOrderTimer1) {
    TCCR1A = Byte(kBoxTimer1);
    TCCR1B = Byte(kBoxTimer1 + 1);
  }
}

void CountEdge(uint8_t motor, bool a, bool b) {
  if (a == b) {
    --Long(static_cast<uint16_t>(kBoxCounts + 4 * motor));
  } else {
    ++Long(static_cast<uint16_t>(kBoxCounts + 4 * motor));
  }
}

}  // namespace

// Before main: after a reset by the watchdog it keeps running with its shortest period.
extern "C" void KeepCause() __attribute__((naked, used, section(".init3")));
extern "C" void KeepCause() {
  cause = MCUSR;
  MCUSR = 0;
  wdt_disable();
}

ISR(INT0_vect) { CountEdge(0, PIND & _BV(PD2), PIND & _BV(PD4)); }
ISR(INT1_vect) { CountEdge(1, PIND & _BV(PD3), PIND & _BV(PD5)); }

ISR(ADC_vect) {
  const uint16_t code = ADC;
  if (channel < 2) {
    Word(static_cast<uint16_t>(kBoxAdc + 2 * channel)) = code;
  } else {
    Byte(kBoxBandgap) = static_cast<uint8_t>(code);
  }
  ++Word(kBoxConversions);
  channel = channel == 2 ? 0 : static_cast<uint8_t>(channel + 1);
  ADMUX = static_cast<uint8_t>(_BV(REFS0) | (channel == 2 ? 14 : channel));
  if (channel != 0) ADCSRA |= _BV(ADSC);
}

ISR(TIMER2_COMPA_vect) {
  GPIOR0 = 1;
  ++Long(kBoxTicks);
  if (Byte(kBoxMissed) < 255) ++Byte(kBoxMissed);
  if (Byte(kBoxMissed) == kLimitMilliseconds) SetMotors(0, 0, 0, 0);
  if (Byte(kBoxNewDuty)) {
    Byte(kBoxNewDuty) = 0;
    SetMotors(Word(kBoxDuty), Word(kBoxDuty + 2), Byte(kBoxWindsIn), Byte(kBoxEnable));
  }
  ADCSRA |= _BV(ADSC);
  Word(kBoxEarly) = ADC;  // of the previous conversion
  wdt_reset();
  GPIOR0 = 0;
}

ISR(TWI_vect) {
  const uint8_t status = TWSR & 0xF8;
  Byte(static_cast<uint16_t>(kBoxStatus + (Byte(kBoxStatusCount) & 31))) = status;
  ++Byte(kBoxStatusCount);
  for (uint8_t i = Byte(kBoxStretch); i > 0; --i) {
    for (uint8_t j = 0; j < 53; ++j) asm volatile("");
  }
  uint8_t acknowledge = _BV(TWEA);
  const uint8_t refused = Byte(kBoxNackFrom), last = Byte(kBoxLastByte);
  switch (status) {
    case 0x60:
    case 0x70:
      position = 0;
      if (refused == 1) acknowledge = 0;
      break;
    case 0x80:
    case 0x90:
      if (position < 64) Byte(static_cast<uint16_t>(kBoxReceived + position)) = TWDR;
      ++position;
      if (position == Byte(kBoxLetGo)) {
        TWCR = _BV(TWINT) | _BV(TWSTO) | _BV(TWEA) | _BV(TWEN) | _BV(TWIE);
        return;
      }
      if (refused != 0 && position + 1 >= refused) acknowledge = 0;
      break;
    case 0xA0:
      Byte(kBoxReceivedCount) = position;
      TakeMessage();
      break;
    case 0xA8:
      position = 0;
      // fall through
    case 0xB8:
      TWDR = Byte(static_cast<uint16_t>(kBoxSend + (position & 63)));
      ++position;
      if (last != 0 && position >= last) acknowledge = 0;
      break;
    case 0x00:
      TWCR = _BV(TWINT) | _BV(TWSTO) | _BV(TWEA) | _BV(TWEN) | _BV(TWIE);
      return;
    default:
      break;
  }
  TWCR = static_cast<uint8_t>(_BV(TWINT) | acknowledge | _BV(TWEN) | _BV(TWIE));
}

int main() {
  if (cause & _BV(PORF)) {
    for (uint16_t address = 0x100; address < 0x200; ++address) Byte(address) = 0;
  } else {
    for (uint16_t address = kBoxStretch; address < kBoxStatus; ++address) Byte(address) = 0;
  }
  Byte(kBoxCause) = cause;
  ++Byte(kBoxBoots);
  Byte(kBoxId) = eeprom_read_byte(nullptr);
  wdt_enable(WDTO_60MS);

  DDRB = _BV(PB0) | _BV(PB1) | _BV(PB2);
  PORTB = _BV(PB4);  // open drain
  DDRD = _BV(PD6) | _BV(PD7);
  TCCR1A = _BV(COM1A1) | _BV(COM1B1);
  TCCR1B = _BV(WGM13) | _BV(CS10);  // mode 8
  ICR1 = kTop;
  SetMotors(0, 0, 0, 0);
  TCCR2A = _BV(WGM21);
  TCCR2B = _BV(CS22);  // prescaler 64
  OCR2A = 249;
  TIMSK2 = _BV(OCIE2A);
  ADMUX = _BV(REFS0);
  ADCSRA = _BV(ADEN) | _BV(ADIE) | _BV(ADPS2) | _BV(ADPS1) | _BV(ADPS0);
  EICRA = _BV(ISC00) | _BV(ISC10);
  EIMSK = _BV(INT0) | _BV(INT1);
  TWAR = static_cast<uint8_t>((kFirstAddress + Byte(kBoxId)) << 1 | _BV(TWGCE));
  TWCR = _BV(TWEA) | _BV(TWEN) | _BV(TWIE);
  set_sleep_mode(SLEEP_MODE_IDLE);
  sleep_enable();
  sei();
  for (;;) {
    sleep_cpu();
    if (Byte(kBoxOrder)) Obey();
  }
}
