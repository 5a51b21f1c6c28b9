/// Emulated I2C bus with one master and clock stretching by slaves, bit-exact in time.
///
/// The bus runs ahead of its slaves: it computes the time of the next event on the wires, schedules
/// the event in the slaves (`I2cSlave::Schedule`), lets them run up to this time and a little
/// beyond, and then reads their answers and the times at which they released the clock.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/virtual_robot/emulated_time.h"

namespace taut::virtual_robot {

/// Event on the wires for a slave.
struct BusEvent {
  enum class Kind {
    kStart,    ///< Start or repeated start.
    kAddress,  ///< The ninth clock of an address byte.
    kByte,     ///< The ninth clock of any other byte.
    kStop,
    kError  ///< An illegal start or stop: all state machines abort their transfer.
  };
  Kind kind = Kind::kStart;
  Time at = 0;
  std::uint8_t byte = 0;      ///< Byte on the wires.
  bool master_reads = false;  ///< The master reads this byte ...
  bool master_acked = false;  ///< ... and requests another one.
};

/// A slave on the bus. Called by the bus's thread.
class I2cSlave {
 public:
  virtual ~I2cSlave() = default;
  /// Schedules an event; at most one is pending at a time.
  virtual void Schedule(const BusEvent& event) = 0;
  virtual bool Powered() const = 0;
  /// `HoldsClock` returns whether the slave holds the clock low. `ReleasedAt` returns when it last
  /// released the clock, but not before the last event.
  virtual bool HoldsClock() const = 0;
  virtual Time ReleasedAt() const = 0;
  /// Returns whether the slave pulled the data line low in the ninth clock of the last event.
  virtual bool Acked() const = 0;
  /// Returns the next byte that the slave sends; all ones if none.
  virtual std::uint8_t NextByte() const = 0;
};

/// One step of a master's transfer.
struct BusStep {
  enum class Kind { kStart, kWrite, kRead, kStop };
  Kind kind = Kind::kStart;
  std::uint8_t byte = 0;    ///< Byte to write. After a start: address << 1, | 1 to read.
  bool acknowledge = true;  ///< Acknowledge the read byte: more bytes are wanted.
};

enum class BusOutcome {
  kDone,
  kNoAcknowledge,  ///< No slave acknowledged a written byte.
  kStuck,          ///< A line stayed low for longer than `BusTiming::timeout`.
  kError           ///< An illegal start or stop in between.
};

struct BusResult {
  BusOutcome outcome = BusOutcome::kDone;
  std::vector<std::uint8_t> read;
  int written = 0;  ///< Number of acknowledged bytes, including addresses.
  Time ended = 0;
};

struct BusTiming {
  Time bit = 2'500 * kNanosecond;  ///< Duration of a bit, at 400 kHz.
  Time byte_gap = 0;               ///< Gap between two bytes, caused by the master (assumed).
  Time timeout = 25 * kMillisecond;
};

/// Statistics of clock stretching over all bytes.
struct StretchStats {
  std::uint64_t bytes = 0;
  Time sum = 0, longest = 0;
};

class I2cBus {
 public:
  explicit I2cBus(std::uint64_t seed) : seed_(seed) {}

  /// Attaches a slave; slaves answer in this order. They must outlive the bus.
  void Attach(I2cSlave& slave) { slaves_.push_back(&slave); }

  /// Begins a transfer now; none may be in progress. The steps end with a stop, if one is to be
  /// sent. If no slave acknowledges a byte, the remaining steps are skipped up to the next stop, if
  /// `stop_after_nack`.
  void Begin(Time now, std::vector<BusStep> steps, const BusTiming& timing,
             bool stop_after_nack = true);
  bool Busy() const { return busy_; }
  /// Removes the master: nothing follows the scheduled event. Slaves see no stop.
  void Abandon(Time now);
  /// Returns the result of the last transfer, once it has ended.
  const BusResult& result() const { return result_; }

  /// Reads the slaves' answers up to `now` and continues.
  void Step(Time now);
  /// Returns the time up to which slaves may run before the next `Step`, with all events until then
  /// scheduled. Later than `now`, which is the time of the last `Step`.
  Time SafeUntil(Time now) const;

  // Injected faults.
  /// Flips each bit on the wires, of bytes and acknowledgements, with this probability.
  void SetNoise(double flips_per_bit) { flips_per_bit_ = flips_per_bit; }
  /// Inserts an illegal start into the next byte.
  void DisturbNextByte() { disturb_ = true; }
  void HoldDataLow(bool low) { data_low_ = low; }
  void HoldClockLow(bool low) { clock_low_ = low; }

  const StretchStats& stretch() const { return stretch_; }
  void ForgetStretch() { stretch_ = {}; }
  std::uint64_t flipped_bits() const { return flipped_; }

 private:
  enum class Phase { kIdle, kReady, kScheduled };

  void Put(Time at);  ///< Puts the next step on the wires, at `at` or later.
  void Look();        ///< Reads the answers to the last event.
  void Finish(BusOutcome outcome, Time at);
  bool Flip();  ///< Returns whether noise flips this bit.
  std::uint8_t Noisy(std::uint8_t byte);
  Time Duration(const BusStep& step) const;

  std::uint64_t seed_;
  std::vector<I2cSlave*> slaves_;
  BusTiming timing_;
  std::vector<BusStep> steps_;
  std::size_t next_ = 0;
  bool busy_ = false, stop_after_nack_ = true, address_follows_ = false;
  Phase phase_ = Phase::kIdle;
  Time happened_ = 0;  ///< End of the last step.
  BusEvent event_;     ///< The scheduled event, while `kScheduled`.
  BusResult result_;
  StretchStats stretch_;

  double flips_per_bit_ = 0;
  std::uint64_t drawn_ = 0, flipped_ = 0;
  bool abandoned_ = false, disturb_ = false, data_low_ = false, clock_low_ = false;
  bool blocked_ = false;  ///< A line held low by a fault delayed the next step.
};

}  // namespace taut::virtual_robot
