// Fuzz target of MJCF models. An accepted model is written and read back in one of four ways: as a
// model file with an experiment file, or as MJCF with each option.
#include "taut/mjcf.h"

#include "fuzz/reader_targets.h"
#include "fuzz/refusals.h"
#include "fuzz/text_input.h"

namespace {

using taut::Diagnostics;
using taut::ImportedMjcf;
using taut::MjcfCables;
using taut::fuzz::Folder;
using taut::fuzz::Must;

void CheckFiles(const ImportedMjcf& made, const Folder& folder) {
  Diagnostics writing;
  const auto model = ModelYaml(made.robot, "", writing);
  Must(model.has_value() == writing.ok(), "a model file or an error");
  if (!model) return;
  Must(taut::fuzz::CheckModelFile(folder.Write("model.yaml", model->data(), model->size())),
       "a model file that can be read: " + *model);
  const std::string text = MjcfExperimentYaml(made, "model.yaml");
  Diagnostics reading;
  const auto experiment =
      taut::LoadExperiment(folder.Write("ground.yaml", text.data(), text.size()), {}, reading);
  Must(experiment.has_value(), "an experiment that can be read: " + reading.Format() + text);
  const taut::ModelDef& on = experiment->robot.def;
  Must(on.planes.size() == made.robot.def.planes.size() &&
           on.terrain_boxes.size() == made.robot.def.terrain_boxes.size(),
       "the same terrain");
}

void CheckExport(const ImportedMjcf& made, const taut::MjcfExport& options, const Folder& folder) {
  Diagnostics out;
  const auto xml = ExportMjcf(made.robot.def, options, out);
  Must(xml.has_value() == out.ok(), "MJCF or an error");
  if (!xml) return;
  Diagnostics reading;
  taut::MjcfImport as_written;
  as_written.slack = taut::MjcfSlack::kAsMujoco;  // bars stay bars, and cables never push
  if (options.keyframe) as_written.keyframe = "start";
  const auto again =
      ImportMjcf(folder.Write("again.xml", xml->data(), xml->size()), as_written, reading);
  Must(again.has_value(), "the written file can be read: " + reading.Format() + *xml);
  Must(again->robot.def.bodies.size() == made.robot.def.bodies.size() &&
           again->robot.def.cables.size() == made.robot.def.cables.size(),
       "as many bodies and cables");
}

}  // namespace

/// The size of the input selects the options.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Folder folder;
  taut::MjcfImport options;
  if (size % 2 == 1) options.slack = taut::MjcfSlack::kAsMujoco;
  if (size / 2 % 2 == 1) options.keyframe = "0";
  if (size / 4 % 4 == 1) options.length_unit_m = 0.1, options.mass_unit_kg = 1e-3;
  options.without_frictionloss = size / 4 % 2 == 1;
  Diagnostics out;
  const auto made = ImportMjcf(folder.Write("model.xml", data, size), options, out);
  taut::fuzz::CheckReading(made.has_value(), out);
  if (!made) return 0;
  taut::fuzz::CheckRobot(made->robot);
  switch (taut::fuzz::Pick(4, data, size)) {
    case 0:
      CheckFiles(*made, folder);
      break;
    case 1:
      CheckExport(*made, {}, folder);
      break;
    case 2:
      CheckExport(*made, {.keyframe = true}, folder);
      break;
    default:
      CheckExport(*made, {.cables = MjcfCables::kSpring}, folder);
  }
  return 0;
}
