// Stores the number of cycles from an overflow of Timer 0 to the first instruction of its
// interrupt: asleep if the byte at 0x131 is 1, else awake.
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>

ISR(TIMER0_OVF_vect, ISR_NAKED) {
  asm volatile(
      "in r24, %0\n"
      "sts 0x130, r24\n"
      "reti\n" ::"I"(_SFR_IO_ADDR(TCNT0)));
}

int main() {
  TCCR0B = _BV(CS00);  // no prescaler
  TIMSK0 = _BV(TOIE0);
  set_sleep_mode(SLEEP_MODE_IDLE);
  sleep_enable();
  sei();
  asm volatile(
      "1: lds r25, 0x131\n"
      "cpi r25, 1\n"
      "brne 1b\n"
      "sleep\n"
      "rjmp 1b\n");
}
