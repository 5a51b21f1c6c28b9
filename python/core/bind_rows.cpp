// `taut.Rows`: views of a batch's memory, without copies.
#include <array>

#include "taut/body_rows.h"
#include "worlds.h"

namespace taut::python {
namespace {

/// Type of `batch.rows`.
struct RowsView {
  std::shared_ptr<Worlds> worlds;

  /// Returns a view (groups, count, lanes) of rows that begin at `first` in group 0. The view keeps
  /// the batch alive.
  py::array View(const double* first, py::ssize_t count, bool written) const {
    const auto number = static_cast<py::ssize_t>(sizeof(double));
    const auto [groups, lanes, stride] = worlds->Look([](WorldBatch& b) {
      return std::array<py::ssize_t, 3>{b.groups(), b.lanes(), GroupStride(b)};
    });
    py::array_t<double> a({groups, count, lanes}, {stride * number, lanes * number, number}, first,
                          py::cast(worlds));
    if (!written) a.attr("setflags")(py::arg("write") = false);
    return a;
  }
  py::array Cables(const double* ReadingRows::*field) const {
    const double* const first = worlds->Look([&](WorldBatch& b) {
      for (int g = b.groups(); g-- > 1;) b.Sense(g);
      return b.Cables(0).*field;
    });
    return View(first, worlds->cables(), false);
  }
  py::array Bodies(const double* BodyRows::*field) const {
    const double* const first =
        worlds->Look([&](WorldBatch& b) { return RowsOfBodies(b, 0).*field; });
    return View(first, 3 * worlds->bodies(), false);
  }
};

}  // namespace

void AddRows(py::module_& module, BatchType& batch) {
  py::class_<RowsView> type(
      module, "Rows",
      "Views of a batch's numbers in memory, without copies. World w is at [w // lanes, :, w % "
      "lanes]; lanes of the last group beyond `worlds` are unused. An array keeps its batch alive. "
      "Lengths, rates and tensions are updated when `rows.NAME` is read; all other values are "
      "always current. While another Python thread steps the batch, arrays contain values from "
      "before, within or after the step.");
  const auto bodies = [&](const char* name, const double* BodyRows::*field, const char* words) {
    type.def_property_readonly(
        name, [=](const RowsView& rows) { return rows.Bodies(field); }, words);
  };
  bodies("body_position_m", &BodyRows::position_m,
         "(groups, 3 * bodies, lanes) float64: x, y, z of the centers of mass, body by body, in W "
         "[m]. Read only.");
  bodies("body_velocity_m_per_s", &BodyRows::velocity_m_per_s,
         "(groups, 3 * bodies, lanes) float64: velocities of the centers of mass, in W [m/s]. Read "
         "only.");
  const auto cables = [&](const char* name, const double* ReadingRows::*field, const char* words) {
    type.def_property_readonly(
        name, [=](const RowsView& rows) { return rows.Cables(field); }, words);
  };
  cables("rest_length_m", &ReadingRows::rest_length_m,
         "(groups, cables, lanes) float64: rest lengths [m]. Read only.");
  cables("cable_length_m", &ReadingRows::length_m,
         "(groups, cables, lanes) float64: path lengths between the ends, along all attachments "
         "[m]. Read only.");
  cables("cable_rate_m_per_s", &ReadingRows::rate_m_per_s,
         "(groups, cables, lanes) float64: rates of the lengths [m/s]. Read only.");
  cables("tension_n", &ReadingRows::tension_n,
         "(groups, cables, lanes) float64: tensions as measured by a load cell, spring and damper "
         "[N]. Read only.");
  cables("elastic_n", &ReadingRows::elastic_n,
         "(groups, cables, lanes) float64: spring part of the tensions, max(0, k (l - L)) [N]. "
         "Read only.");
  type.def_property_readonly(
      "rest_length_target_m",
      [](const RowsView& rows) {
        const double* const first =
            rows.worlds->Look([](WorldBatch& b) { return b.Cables(0).rest_length_target_m; });
        return rows.View(first, rows.worlds->cables(), true);
      },
      "(groups, cables, lanes) float64: rest-length targets of the actuators [m]. Writable; values "
      "apply from the next step. Do not write while another Python thread steps the batch.");
  batch.def_property_readonly(
      "rows", [](const std::shared_ptr<Worlds>& worlds) { return RowsView{worlds}; },
      "Views of the batch's memory, without copies: see `taut.Rows`.");
}

}  // namespace taut::python
