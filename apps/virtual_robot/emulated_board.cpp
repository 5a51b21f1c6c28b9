#include "apps/virtual_robot/emulated_board.h"

#include <utility>

#include "apps/virtual_robot/simavr.h"
#include "base/assert.h"

namespace taut::virtual_robot {
namespace {

struct Pin {
  char port;
  int bit;
};
constexpr Pin kEncoderA[2] = {{'D', 2}, {'D', 3}}, kEncoderB[2] = {{'D', 4}, {'D', 5}},
              kDirection[2] = {{'D', 7}, {'B', 0}}, kEnable = {'D', 6}, kDriverFault = {'B', 4};

}  // namespace

const char* Name(ResetCause cause) {
  switch (cause) {
    case ResetCause::kPowerOn:
      return "power on";
    case ResetCause::kExternal:
      return "reset pin";
    case ResetCause::kBrownOut:
      return "brown-out";
    case ResetCause::kWatchdog:
      return "watchdog";
  }
  return "unknown";
}

Board::Board(std::shared_ptr<const AvrProgram> program, const BoardOptions& options)
    : id_(options.id), program_(std::move(program)), drift_ppm_(options.drift_ppm) {
  core_ = std::make_unique<AvrCore>(*program_);
  core_->LoadEeprom(0, {static_cast<std::uint8_t>(options.id)});
  core_->LoadEeprom(1, options.eeprom);
  core_->adc_code = [this](int channel) { return adc_code ? adc_code(channel, now()) : 0; };
  core_->on_marker = [this](std::uint8_t value) {
    marker_ = value;
    if (on_marker) on_marker(cycle(), value);
  };
  core_->on_crash = [this] {
    ++crashes_;
    Trouble("the program has crashed: it left its memory, or sleeps with interrupts off");
  };
  core_->on_message = [this](const std::string& text) { Trouble(text); };
  clock_.Set(0, core_->cycle(), drift_ppm_);
  twi_ = std::make_unique<TwiSlave>(core_->avr(), clock_);
  core_->on_reset = [this](std::uint8_t cause) {
    twi_->AfterReset();
    ++resets_;
    if (on_reset) on_reset(now(), static_cast<ResetCause>(cause));
  };
  SetDriverFault(false);
  for (int motor = 0; motor < 2; ++motor) SetEncoderEdges(motor, {EncoderEdge{}});
  Reset(0, ResetCause::kPowerOn);
  resets_ = 0;
}

Board::~Board() = default;

std::uint64_t Board::cycle() const { return core_->cycle(); }
Time Board::now() const { return clock_.StartOf(core_->cycle()); }

void Board::Trouble(const std::string& what) const {
  if (on_trouble) on_trouble(now(), what);
}

void Board::RunUntil(Time until) {
  if (running()) core_->RunUntil(clock_.CycleAt(until));
}

MotorDrive Board::Drive(int motor) const {
  TAUT_ASSERT(motor == 0 || motor == 1);
  if (!powered_ || brown_out_) return {};
  const auto drives = [&](Pin pin) { return core_->Drives(pin.port, pin.bit); };
  const double duty = core_->PwmDuty(motor);
  return {drives(kDirection[motor]) ? duty : -duty, drives(kEnable)};
}

void Board::SetEncoderEdges(int motor, const std::vector<EncoderEdge>& edges) {
  TAUT_ASSERT(motor == 0 || motor == 1);
  std::vector<PinLevel> levels;
  EncoderEdge& last = encoder_[static_cast<std::size_t>(motor)];
  for (const EncoderEdge& edge : edges) {
    if (edge.a != last.a) {
      levels.push_back(
          {clock_.CycleAt(edge.at), kEncoderA[motor].port, kEncoderA[motor].bit, edge.a});
    }
    if (edge.b != last.b) {
      levels.push_back(
          {clock_.CycleAt(edge.at), kEncoderB[motor].port, kEncoderB[motor].bit, edge.b});
    }
    last = edge;
  }
  if (running()) {
    core_->SchedulePins(levels);
  } else {
    for (const PinLevel& level : levels) core_->SetPin(level.port, level.bit, level.high);
  }
}

void Board::SetDriverFault(bool fault) {
  core_->SetPin(kDriverFault.port, kDriverFault.bit, !fault);
}

void Board::SetDrift(Time now, double ppm) {
  drift_ppm_ = ppm;
  const Time in_its_time = clock_.StartOf(core_->cycle());
  clock_.Set(running() ? in_its_time : now, core_->cycle(), ppm);
}

void Board::Reset(Time now, ResetCause cause) {
  clock_.Set(now, core_->cycle(), drift_ppm_);
  twi_->SetPowered(true);
  core_->Reset(static_cast<std::uint8_t>(cause), cause == ResetCause::kPowerOn);
}

void Board::SetPower(Time now, bool on) {
  if (on == powered_) return;
  powered_ = on;
  core_->SettlePins();
  twi_->SetPowered(on && !brown_out_);
  if (on && !brown_out_) Reset(now, ResetCause::kPowerOn);
}

void Board::SetBrownOut(Time now, bool low) {
  if (low == brown_out_) return;
  brown_out_ = low;
  core_->SettlePins();
  twi_->SetPowered(powered_ && !low);
  if (!low && powered_) Reset(now, ResetCause::kBrownOut);
}

void Board::Hang() {
  if (running()) core_->Hang();
}

std::uint8_t Board::Memory(std::uint16_t address) const { return core_->Memory(address); }
void Board::SetMemory(std::uint16_t address, std::uint8_t value) {
  core_->SetMemory(address, value);
}
std::uint8_t Board::stack_probe() const { return core_->Memory(kGpior1); }
int Board::DeepestStack() const { return core_->DeepestStack(); }
int Board::StaticMemory() const {
  return static_cast<int>(program_->free_memory - AvrProgram::kMemoryStart);
}
std::vector<std::uint8_t> Board::Eeprom() const { return core_->Eeprom(); }

}  // namespace taut::virtual_robot
