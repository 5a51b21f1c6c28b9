// Rows of a batch as they lie in memory, without a copy.
#include <array>

#include "taut/body_rows.h"
#include "worlds.h"

namespace taut::python {
namespace {

/// `batch.rows`.
struct RowsView {
  std::shared_ptr<Worlds> worlds;

  /// A view (groups, count, lanes) of rows that begin at `first` in group 0. It keeps the batch
  /// alive.
  py::array View(const double* first, py::ssize_t count, bool written) const {
    const auto number = static_cast<py::ssize_t>(sizeof(double));
    const auto [groups, lanes, stride] = worlds->Look([](Batch& b) {
      return std::array<py::ssize_t, 3>{b.groups(), b.lanes(), GroupStride(b)};
    });
    py::array_t<double> a({groups, count, lanes}, {stride * number, lanes * number, number}, first,
                          py::cast(worlds));
    if (!written) a.attr("setflags")(py::arg("write") = false);
    return a;
  }
  py::array Cables(const double* ReadingRows::*field) const {
    const double* const first = worlds->Look([&](Batch& b) {
      for (int g = b.groups(); g-- > 1;) b.Sense(g);
      return b.Cables(0).*field;
    });
    return View(first, worlds->cables(), false);
  }
  py::array Bodies(const double* BodyRows::*field) const {
    const double* const first = worlds->Look([&](Batch& b) { return RowsOfBodies(b, 0).*field; });
    return View(first, 3 * worlds->bodies(), false);
  }
};

}  // namespace

void AddRows(py::module_& module, BatchType& batch) {
  py::class_<RowsView> type(
      module, "Rows",
      "Numbers of a batch where they lie, without a copy. World w is at [w // lanes, :, w % "
      "lanes]; "
      "the last group has a full register's worlds, those behind `worlds` are of no use. An array "
      "stays good as long as anybody has it. What lengths, rates and tensions show is of the "
      "moment when `rows.NAME` was last looked up, all else of now. While another Python thread "
      "steps the batch, arrays show numbers of before, of after or of between.");
  const auto bodies = [&](const char* name, const double* BodyRows::*field, const char* words) {
    type.def_property_readonly(
        name, [=](const RowsView& rows) { return rows.Bodies(field); }, words);
  };
  bodies(
      "body_position_m", &BodyRows::position_m,
      "(groups, 3 * bodies, lanes) float64: x, y, z of body after body, of their centres of mass "
      "in W [m]. Read only.");
  bodies("body_velocity_m_per_s", &BodyRows::velocity_m_per_s,
         "The same of their velocities [m/s]. Read only.");
  const auto cables = [&](const char* name, const double* ReadingRows::*field, const char* words) {
    type.def_property_readonly(
        name, [=](const RowsView& rows) { return rows.Cables(field); }, words);
  };
  cables("rest_length_m", &ReadingRows::rest_length_m,
         "(groups, cables, lanes) float64 [m]. Read only.");
  cables("cable_length_m", &ReadingRows::length_m,
         "The same, between the ends along all attachments [m]. Read only.");
  cables("cable_rate_m_per_s", &ReadingRows::rate_m_per_s,
         "The same, of the lengths [m/s]. Read only.");
  cables("tension_n", &ReadingRows::tension_n,
         "The same, spring and damper: what a load cell feels [N]. Read only.");
  cables("elastic_n", &ReadingRows::elastic_n, "The same, max(0, k (l - L)) alone [N]. Read only.");
  type.def_property_readonly(
      "rest_length_target_m",
      [](const RowsView& rows) {
        const double* const first =
            rows.worlds->Look([](Batch& b) { return b.Cables(0).rest_length_target_m; });
        return rows.View(first, rows.worlds->cables(), true);
      },
      "(groups, cables, lanes) float64: the actuators' targets [m]. What is written here is "
      "commanded from the next step on; not while another Python thread steps the batch.");
  batch.def_property_readonly(
      "rows", [](const std::shared_ptr<Worlds>& worlds) { return RowsView{worlds}; },
      "`Rows`: views instead of copies.");
}

}  // namespace taut::python
