/// A two-wire bus with one master, whose clock every slave may stretch, bit-exact in time.
///
/// The bus runs ahead of its slaves: it knows when the next thing happens on the wires before it
/// happens, tells the slaves (`I2cSlave::Schedule`), lets them run up to that time and a little
/// beyond, and then asks what they answered and since when they let go of the clock.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/virtual_robot/emulated_time.h"

namespace taut::virtual_robot {

/// What a slave sees on the wires.
struct BusEvent {
  enum class Kind {
    kStart,    ///< Start or repeated start.
    kAddress,  ///< The ninth clock of an address byte.
    kByte,     ///< The ninth clock of any other byte.
    kStop,
    kError  ///< A start or stop where none may be: all state machines fall out of their transfer.
  };
  Kind kind = Kind::kStart;
  Time at = 0;
  std::uint8_t byte = 0;      ///< As it was on the wires.
  bool master_reads = false;  ///< The master listens to this byte ...
  bool master_acked = false;  ///< ... and asks for another one.
};

/// Somebody on the bus. Called by the bus's thread.
class I2cSlave {
 public:
  virtual ~I2cSlave() = default;
  /// Something that will happen; at most one is on its way at a time.
  virtual void Schedule(const BusEvent& event) = 0;
  virtual bool Powered() const = 0;
  /// Whether it keeps the clock low now, and until when it last did. Not before the last event.
  virtual bool HoldsClock() const = 0;
  virtual Time ReleasedAt() const = 0;
  /// Whether it pulled the data line low in the ninth clock of the last event.
  virtual bool Acked() const = 0;
  /// What it puts on the wires with the next byte, all ones if nothing.
  virtual std::uint8_t NextByte() const = 0;
};

/// One thing that a master does.
struct BusStep {
  enum class Kind { kStart, kWrite, kRead, kStop };
  Kind kind = Kind::kStart;
  std::uint8_t byte = 0;    ///< To write. After a start: address << 1, | 1 to read.
  bool acknowledge = true;  ///< Of a byte that is read: more is wanted.
};

enum class BusOutcome {
  kDone,
  kNoAcknowledge,  ///< A byte that was written found nobody.
  kStuck,          ///< A line stayed low for longer than `BusTiming::timeout`.
  kError           ///< An illegal start or stop in between.
};

struct BusResult {
  BusOutcome outcome = BusOutcome::kDone;
  std::vector<std::uint8_t> read;
  int written = 0;  ///< Bytes that were acknowledged, addresses included.
  Time ended = 0;
};

struct BusTiming {
  Time bit = 2'500 * kNanosecond;  ///< 400 kHz.
  Time byte_gap = 0;               ///< Between two bytes, by the master itself [?].
  Time timeout = 25 * kMillisecond;
};

/// How long the clock was held, over all bytes.
struct StretchStats {
  std::uint64_t bytes = 0;
  Time sum = 0, longest = 0;
};

class I2cBus {
 public:
  explicit I2cBus(std::uint64_t seed) : seed_(seed) {}

  /// In the order in which they are asked. They outlive the bus.
  void Attach(I2cSlave& slave) { slaves_.push_back(&slave); }

  /// Begins a transfer now. None is under way. The steps end with a stop where one is to be sent;
  /// where a byte finds nobody, what is left is skipped up to the next stop, if `stop_after_nack`.
  void Begin(Time now, std::vector<BusStep> steps, const BusTiming& timing,
             bool stop_after_nack = true);
  bool Busy() const { return busy_; }
  /// The master is gone: nothing more comes after what is on its way. Slaves learn of no stop.
  void Abandon(Time now);
  /// Of the last transfer, once it is over.
  const BusResult& result() const { return result_; }

  /// Looks at what the slaves did up to `now` and goes on.
  void Step(Time now);
  /// How far slaves may run before the next `Step`: until then they learn all that happens. Beyond
  /// `now`, which is that of the last `Step`.
  Time SafeUntil(Time now) const;

  // Faults.
  /// Each bit on the wires, of bytes and acknowledgements, is turned over with this probability.
  void SetNoise(double flips_per_bit) { flips_per_bit_ = flips_per_bit; }
  /// Within the next byte there will be an illegal start.
  void DisturbNextByte() { disturb_ = true; }
  void HoldDataLow(bool low) { data_low_ = low; }
  void HoldClockLow(bool low) { clock_low_ = low; }

  const StretchStats& stretch() const { return stretch_; }
  void ForgetStretch() { stretch_ = {}; }
  std::uint64_t flipped_bits() const { return flipped_; }

 private:
  enum class Phase { kIdle, kReady, kScheduled };

  void Put(Time at);  ///< Puts the next step on the wires, to happen from `at` on.
  void Look();        ///< At the answers to what has happened.
  void Finish(BusOutcome outcome, Time at);
  bool Flip();  ///< Whether noise turns this bit over.
  std::uint8_t Noisy(std::uint8_t byte);
  Time Duration(const BusStep& step) const;

  std::uint64_t seed_;
  std::vector<I2cSlave*> slaves_;
  BusTiming timing_;
  std::vector<BusStep> steps_;
  std::size_t next_ = 0;
  bool busy_ = false, stop_after_nack_ = true, address_follows_ = false;
  Phase phase_ = Phase::kIdle;
  Time happened_ = 0;  ///< When the last step ended.
  BusEvent event_;     ///< On its way, while `kScheduled`.
  BusResult result_;
  StretchStats stretch_;

  double flips_per_bit_ = 0;
  std::uint64_t drawn_ = 0, flipped_ = 0;
  bool abandoned_ = false, disturb_ = false, data_low_ = false, clock_low_ = false;
  bool blocked_ = false;  ///< A line that a fault held low kept the next step waiting.
};

}  // namespace taut::virtual_robot
