/// What `taut.Batch` is in C++, for the files that give it its methods.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "owner.h"
#include "taut/batch.h"
#include "text.h"

namespace taut::python {

/// Threads: any of Python's; they wait for each other.
class Worlds {
 public:
  Worlds(const ModelDef& def, int worlds, int threads, const std::optional<std::string>& simd) {
    if (worlds < 1) throw py::value_error(fmt::format("worlds: {}; at least 1", worlds));
    if (threads < 0) throw py::value_error(fmt::format("threads: {}; 0 is one a core", threads));
    BatchOptions options;
    options.worlds = worlds;
    options.threads = threads;
    options.simd = SimdOf(simd);
    Diagnostics said;
    std::unique_ptr<Batch> batch;
    {
      const py::gil_scoped_release others;
      if (auto model = Model::Compile(def, said)) {
        batch = std::make_unique<Batch>(std::move(model), options);
      }
    }
    if (!batch) Refuse(said);
    Tell(said);
    owned_ = std::make_unique<Owner<Batch>>(std::move(batch), "this batch was");
  }

  template <class F>
  auto With(F f) {
    return owned_->With(f);
  }

  const ModelDef& def() const { return owned_->peek().model().def(); }
  int worlds() const { return owned_->peek().worlds(); }
  int lanes() const { return owned_->peek().lanes(); }
  int World(py::ssize_t world) const { return Index(world, worlds(), "world"); }
  py::ssize_t bodies() const { return static_cast<py::ssize_t>(def().bodies.size()); }
  py::ssize_t cables() const { return static_cast<py::ssize_t>(def().cables.size()); }
  py::ssize_t nodes() const { return static_cast<py::ssize_t>(def().nodes.size()); }

  /// An array (worlds, count, width), or (worlds, count) if the width is 1: put(batch, world,
  /// index, numbers).
  template <class Put>
  py::array_t<double> Read(const py::object& out, py::ssize_t count, py::ssize_t width, Put put) {
    std::vector<py::ssize_t> shape{worlds(), count};
    if (width > 1) shape.push_back(width);
    py::array_t<double> a = Output(out, shape);
    double* to = a.mutable_data();
    With([&](Batch& batch) {
      for (int w = 0; w < batch.worlds(); ++w) {
        for (int i = 0; i < static_cast<int>(count); ++i, to += width) put(batch, w, i, to);
      }
    });
    return a;
  }

 private:
  std::unique_ptr<Owner<Batch>> owned_;
};

/// `value`; ValueError, which names `what`, unless it is a positive number.
inline double Positive(double value, const char* what) {
  if (!(value > 0) || !std::isfinite(value)) {
    throw py::value_error(fmt::format("{}: {}; a positive number", what, value));
  }
  return value;
}

using BatchType = py::class_<Worlds, std::shared_ptr<Worlds>>;

/// Give the type its part: rows that are no copies; sequences of targets, whole.
void AddRows(py::module_& module, BatchType& type);
void AddSequences(BatchType& type);

}  // namespace taut::python
