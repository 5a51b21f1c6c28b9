/// Implementation data of a WorldBatch, shared by several files.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <mutex>
#include <vector>

#include "base/assert.h"
#include "base/out_of_memory.h"
#include "base/thread_pool.h"
#include "math/vec.h"
#include "sim/batch/check_index.h"
#include "sim/batch/substeps.h"
#include "sim/data/group.h"
#include "sim/data/tables.h"
#include "taut/world_batch.h"

namespace taut {

/// Frees memory of AllocateAligned.
struct Free {
  void* first = nullptr;  ///< Start of the allocation, before the aligned address.
  void operator()(void*) const noexcept { std::free(first); }
};
template <class T>
using Aligned = std::unique_ptr<T[], Free>;

/// Allocates zeroed memory aligned to a cache line. The operating system provides pages of large
/// blocks on their first use. Therefore the scratch memory of large models occupies only the part
/// that their steps use. Steps use all of this memory only if all bodies form one island.
template <class T>
Aligned<T> AllocateAligned(std::size_t count) {
  constexpr std::size_t kLine = 64;
  void* const first = std::calloc(count * sizeof(T) + 2 * kLine, 1);
  if (first == nullptr) base::OutOfMemory();
  const std::size_t past = reinterpret_cast<std::uintptr_t>(first) % kLine;
  char* const aligned = static_cast<char*>(first) + (kLine - past) % kLine;
  return Aligned<T>(reinterpret_cast<T*>(aligned), Free{first});
}

/// Allocates the memory of a step for one thread, and divides it for the model of `view`.
inline Aligned<char> AllocateScratch(const sim::Kernel& kernel, const sim::View& view) {
  Aligned<char> scratch = AllocateAligned<char>(kernel.scratch_bytes(view));
  kernel.lay_out(view, scratch.get());
  return scratch;
}

struct WorldBatch::Impl {
  Impl(std::shared_ptr<const Model> m, const WorldBatchOptions& o);

  std::shared_ptr<const sim::Tables> model;
  sim::View view;
  sim::FrictionTable friction;  ///< Not used (null in `view`) if two coefficients per pair suffice.
  WorldBatchOptions options;
  const sim::Kernel* kernel;
  sim::Layout layout;
  sim::SubstepRule substep_rule;
  mutable std::vector<sim::Group> groups;
  Aligned<double> rows;
  Aligned<sim::NearParts> kept;
  std::vector<int> slots_used;
  std::vector<int> forced;
  std::vector<sim::MovingPair> near;
  std::vector<sim::LaneStatus> status;
  std::vector<Aligned<char>> scratch;  ///< One per thread.
  base::ThreadPool pool;
  mutable std::mutex sensing;  ///< Protects scratch[0] and the kSensed rows in const functions.

  // Checks of arguments from callers (sim/batch/check_index.h). `function`: name of the public
  // function.
  void CheckWorld(const char* function, int world) const noexcept {
    sim::CheckIndex(function, "world", world, options.worlds);
  }
  void CheckBody(const char* function, int world, int body) const noexcept {
    CheckWorld(function, world);
    sim::CheckIndex(function, "body", body, view.body_count);
  }
  void CheckCable(const char* function, int world, int cable) const noexcept {
    CheckWorld(function, world);
    sim::CheckIndex(function, "cable", cable, view.cable_count);
  }
  /// Returns the number of the motor of a cable.
  int CheckMotor(const char* function, int world, int cable) const noexcept {
    CheckCable(function, world, cable);
    const int motor = view.cables[cable].motor;
    if (motor < 0) [[unlikely]] {
      sim::NoMotor(function, cable);
    }
    return motor;
  }
  void CheckNode(const char* function, int world, int node) const noexcept {
    CheckWorld(function, world);
    sim::CheckIndex(function, "node", node, view.node_count);
  }
  /// Returns the row of a parameter.
  int ParameterRow(const char* function, int world, Parameter parameter, int index) const noexcept;

  /// Returns the settings for steps of `step_s`.
  sim::StepSettings SettingsOf(double step_s) const noexcept;

  int lanes() const noexcept { return kernel->lanes; }
  sim::Group& group(int world) const noexcept {
    TAUT_ASSERT(0 <= world && static_cast<std::size_t>(world / lanes()) < groups.size());
    return groups[static_cast<std::size_t>(world / lanes())];
  }
  /// Returns row `row` of a world.
  double& at(int world, int row) const noexcept {
    TAUT_ASSERT(0 <= row && row < layout.rows);
    return group(world).rows[row * lanes() + world % lanes()];
  }
  sim::MotorNumbers<double> motor(int world, int number) const noexcept {
    return Struct<sim::MotorNumbers<double>>(world, layout.motor, number);
  }
  sim::MotorOrders<double> orders(int world, int number) const noexcept {
    return Struct<sim::MotorOrders<double>>(world, layout.orders, number);
  }
  /// Returns the bends of a cable with wrapping, in order along the cable.
  std::vector<sim::WrapPointNumbers<double>> Bends(int world, int cable) const;
  /// Path of a cable with its bends, except bends that it has left.
  struct LaidCable;
  LaidCable Lay(int world, int cable) const;
  Vec3 vec(int world, int row) const noexcept {
    return {at(world, row), at(world, row + 1), at(world, row + 2)};
  }
  void set(int world, int row, double x) const noexcept { at(world, row) = x; }
  void set(int world, int row, const Quat& q) const noexcept {
    at(world, row) = q.w;
    set(world, row + 1, Vec3{q.x, q.y, q.z});
  }
  void set(int world, int row, const Vec3& x) const noexcept {
    at(world, row) = x.x;
    at(world, row + 1) = x.y;
    at(world, row + 2) = x.z;
  }
  /// Returns element `number` of a row of structs of numbers.
  template <class T>
  T Struct(int world, int row, int number) const noexcept {
    constexpr int kWidth = sizeof(T) / sizeof(double);
    double x[kWidth];
    for (int i = 0; i < kWidth; ++i) x[i] = at(world, row + kWidth * number + i);
    T out;
    std::memcpy(&out, x, sizeof(T));
    return out;
  }
  template <class T>
  void SetStruct(int world, int row, const T& value) const noexcept {
    constexpr int kWidth = sizeof(T) / sizeof(double);
    double x[kWidth];
    std::memcpy(x, &value, sizeof(T));
    for (int i = 0; i < kWidth; ++i) at(world, row + i) = x[i];
  }
  void set(int world, int row, const sim::MotorNumbers<double>& x) const noexcept {
    SetStruct(world, row, x);
  }
  void set(int world, int row, const sim::MotorOrders<double>& x) const noexcept {
    SetStruct(world, row, x);
  }
  void set(int world, int row, const sim::WrapPointNumbers<double>& x) const noexcept {
    SetStruct(world, row, x);
  }
  Quat quat(int world, int body) const noexcept {
    const int row = layout.quat + 4 * body;
    return {at(world, row), at(world, row + 1), at(world, row + 2), at(world, row + 3)};
  }
  /// Calls f(index of the contact memory) for each stored contact of a world. Keys ascend within a
  /// body.
  template <class F>
  void ForEachContact(int world, F&& f) const {
    const sim::Group& g = group(world);
    const auto visit = [&](int i) {
      if (at(world, layout.contact_key + i) >= 0) f(i);
    };
    for (int b = 0; b < view.body_count; ++b) {
      for (int k = 0; k < g.slots_used[b]; ++k) visit(view.first_slot[b] + k);
    }
    for (int k = 0; k < g.touches_used; ++k) visit(view.slot_count + k);
  }
  /// Steps all worlds. If `targets_m` is not null, first sets the targets of all cables of all
  /// worlds.
  void Step(double step_s, int count, const double* targets_m) noexcept;
  void StepMasked(double step_s, const std::uint8_t* mask);
  void SetTargets(int group_number, const double* targets_m) const noexcept;
  void SetMass(int world, int body, double mass_kg) noexcept;
  void StartWorld(int world) noexcept;
  /// Calls f(number) for all numbers of a contact in a snapshot.
  template <class F>
  void EachMemory(int world, int contact, F f) const noexcept {
    TAUT_ASSERT(0 <= contact && contact < view.ContactCapacity());
    for (const sim::RowInfo& row : sim::kStateRows) {
      if (row.role != sim::Role::kMemory) continue;
      const int first = layout.*row.first + row.width * contact;
      for (int k = 0; k < row.width; ++k) f(at(world, first + k));
    }
  }
  /// Updates the stiffness bounds of the cables after a change of masses, stiffnesses or dampings.
  void JudgeStiffness(int world) noexcept;
  /// Invalidates the clearances after a setter moved bodies.
  void Moved(int world) noexcept;
  /// Invalidates the averages of the last step after a setter changed cables.
  void ForgetMeans(int world) noexcept;
  /// Makes cables with wrapping straight, because the sides of obstacles on which they pass are
  /// unknown.
  void ForgetBends(int world) noexcept;
  /// Moves the kinematic bodies to their poses at the current time of the world.
  void PlaceMotions(int world) noexcept;
  /// Updates the kSensed rows of the group of a world to the current state. Thread safe.
  void Sense(int world) const noexcept;
  void ForceNode(int world, int node) noexcept;
  /// Changes a command of a motor.
  void Order(int world, int motor, double sim::MotorOrders<double>::*order,
             double value) const noexcept;
  /// Stops the motor of a cable, if it has one, with the backlash of its gear closed.
  void StopMotor(int world, int cable) const noexcept;
};

}  // namespace taut
