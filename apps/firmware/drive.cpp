#include "apps/firmware/drive.h"

#include "apps/firmware/pins.h"
#include "taut/board/motor_loop.h"

void StartDrive() {
  PORTD &= static_cast<uint8_t>(~(kEnable | kDirection0));
  PORTB &= static_cast<uint8_t>(~(kDirection1 | kPwmPins));
  DDRD |= kEnable | kDirection0;
  DDRB |= kDirection1 | kPwmPins;
  PORTB |= kDriverFaultPin;  // pull-up for the driver's open-drain output
  TCCR1A = 1 << COM1A1 | 1 << COM1B1;
  TCCR1B = 1 << WGM13 | 1 << CS10;  // mode 8: phase and frequency correct PWM, top ICR1
  ICR1 = taut::board::kFullWidth;   // 16 MHz / (2 * 400) = 20 kHz, counting up and down
  OCR1A = OCR1B = 0;
}

void SetWidth(uint8_t motor, int16_t signed_width) {
  const bool winds = signed_width > 0;
  const uint16_t width = static_cast<uint16_t>(winds ? signed_width : -signed_width);
  if (motor == 0) {
    if (winds != ((PORTD & kDirection0) != 0)) {
      OCR1A = 0;  // so that the new direction is never driven with the old width
      if (winds)
        PORTD |= kDirection0;
      else
        PORTD &= static_cast<uint8_t>(~kDirection0);
    }
    OCR1A = width;
  } else {
    if (winds != ((PORTB & kDirection1) != 0)) {
      OCR1B = 0;
      if (winds)
        PORTB |= kDirection1;
      else
        PORTB &= static_cast<uint8_t>(~kDirection1);
    }
    OCR1B = width;
  }
}

void SetPower(bool on) {
  if (on) {
    PORTD |= kEnable;
  } else {
    PORTD &= static_cast<uint8_t>(~kEnable);
  }
}

bool DriverSaysFault() { return (PINB & kDriverFaultPin) == 0; }
