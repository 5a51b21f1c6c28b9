#include "apps/firmware/board_sensors.h"

#include <avr/interrupt.h>
#include <util/atomic.h>

#include "apps/firmware/pins.h"

namespace {

constexpr uint8_t kReference = 1 << REFS0;  // the supply AVcc is the reference
volatile uint16_t converted[2];
volatile uint16_t encoder[2];

}  // namespace

ISR(ADC_vect) {
  const uint16_t counts = ADC;  // must precede the change of channel
  const uint8_t channel = ADMUX & 1;
  converted[channel] = counts;
  if (channel == 0) {
    ADMUX = kReference | 1;
    ADCSRA |= 1 << ADSC;
  }
}

// Any edge of A: equal levels of A and B mean one direction. Two counts per line.
ISR(INT0_vect) {
  const uint8_t pins = PIND;
  if (((pins & 1 << PD2) != 0) == ((pins & kEncoderB[0]) != 0)) {
    encoder[0] = encoder[0] - 1;
  } else {
    encoder[0] = encoder[0] + 1;
  }
}
ISR(INT1_vect) {
  const uint8_t pins = PIND;
  if (((pins & 1 << PD3) != 0) == ((pins & kEncoderB[1]) != 0)) {
    encoder[1] = encoder[1] - 1;
  } else {
    encoder[1] = encoder[1] + 1;
  }
}

void StartSensors() {
  ADMUX = kReference;
  ADCSRA = 1 << ADEN | 1 << ADIE | 1 << ADPS2 | 1 << ADPS1 | 1 << ADPS0;  // clock: 125 kHz
  DIDR0 = 1 << ADC0D | 1 << ADC1D;
  EICRA = 1 << ISC00 | 1 << ISC10;
  EIFR = 1 << INTF0 | 1 << INTF1;  // discards edges that arrived while interrupts were off
  EIMSK = 1 << INT0 | 1 << INT1;
}

void StartConversions() {
  ADMUX = kReference;
  ADCSRA |= 1 << ADSC;
}

uint16_t LoadCell(uint8_t motor) {
  uint16_t counts = 0;
  ATOMIC_BLOCK(ATOMIC_FORCEON) { counts = converted[motor]; }
  return counts;
}

uint16_t Encoder(uint8_t motor) {
  uint16_t counts = 0;
  ATOMIC_BLOCK(ATOMIC_FORCEON) { counts = encoder[motor]; }
  return counts;
}
