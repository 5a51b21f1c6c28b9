// Steps of selected worlds: steps whole groups and restores the other lanes.
#include <algorithm>
#include <cstring>

#include "sim/batch/batch_impl.h"

namespace taut {
namespace {

/// Saved state of the lanes of a group that must not step.
class Still {
 public:
  Still(sim::Group& g, int row_count, std::vector<int> lanes)
      : g_(g), row_count_(row_count), lanes_(std::move(lanes)) {
    rows_.reserve(lanes_.size() * static_cast<std::size_t>(row_count));
    for (const int lane : lanes_) {
      for (int row = 0; row < row_count_; ++row) rows_.push_back(At(row, lane));
      status_.push_back(g_.status[lane]);
    }
  }

  void PutBack() {
    const double* from = rows_.data();
    for (std::size_t i = 0; i < lanes_.size(); ++i) {
      for (int row = 0; row < row_count_; ++row) At(row, lanes_[i]) = *from++;
      g_.status[lanes_[i]] = status_[i];
    }
  }

  bool Has(int lane) const { return std::count(lanes_.begin(), lanes_.end(), lane) > 0; }

 private:
  double& At(int row, int lane) {
    return g_.rows[static_cast<std::ptrdiff_t>(row) * g_.lanes + lane];
  }

  sim::Group& g_;
  int row_count_;
  std::vector<int> lanes_;
  std::vector<double> rows_;
  std::vector<sim::LaneStatus> status_;
};

}  // namespace

void WorldBatch::Impl::StepMasked(double step_s, const std::uint8_t* mask) {
  const sim::StepSettings settings = SettingsOf(step_s);
  const int n = lanes();
  auto work = [&](int thread, std::size_t number) {
    sim::Group& g = groups[number];
    const int first = static_cast<int>(number) * n;
    std::vector<int> still;
    for (int lane = 0; lane < n; ++lane) {
      if (first + lane < options.worlds && mask[first + lane] == 0) still.push_back(lane);
    }
    const auto step = [&] {
      kernel->step(view, layout, g, settings, scratch[static_cast<std::size_t>(thread)].get(),
                   step_s, 1);
    };
    if (still.empty()) return step();
    const auto count = static_cast<int>(still.size());
    if (count == std::min(n, options.worlds - first)) return;
    Still held(g, layout.rows, std::move(still));
    const std::vector<int> slots(g.slots_used, g.slots_used + view.body_count);
    const int touches = g.touches_used;
    step();
    held.PutBack();
    // The step may have made the list of near bodies for other poses of these lanes.
    for (int lane = 0; lane < n; ++lane) {
      if (held.Has(lane)) at(first + lane, layout.near_m) = 0.0;
    }
    // All lanes have lists of the same length, the longest one. Entries after the end of a lane's
    // own list are outdated.
    const auto keep = [&](int& used, int before, int first_slot) {
      const int longer = std::max(used, before);
      for (int lane = 0; lane < n; ++lane) {
        for (int i = held.Has(lane) ? before : used; i < longer; ++i) {
          at(first + lane, layout.contact_key + first_slot + i) = sim::kNoKey;
        }
      }
      used = longer;
    };
    for (int b = 0; b < view.body_count; ++b) {
      keep(g.slots_used[b], slots[static_cast<std::size_t>(b)], view.first_slot[b]);
    }
    keep(g.touches_used, touches, view.slot_count);
  };
  pool.ForEach(groups.size(), work);
}

void WorldBatch::StepMasked(double step_s, std::span<const std::uint8_t> mask) {
  sim::CheckStep(__func__, step_s, 1);
  sim::CheckCount(__func__, "word for each world", mask.size(),
                  static_cast<std::size_t>(impl_->options.worlds));
  impl_->StepMasked(step_s, mask.data());
}

}  // namespace taut
