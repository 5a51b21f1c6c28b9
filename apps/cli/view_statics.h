/// Statics of a model for the viewer's page.
#pragma once

#include "apps/viewer/scene.h"
#include "taut/spec.h"

namespace taut::cli {

/// Returns Scene.statics (web/protocol/messages.json) of a model: equilibrium without weight,
/// states of self-stress, mechanisms and the first modes.
viewer::Json ViewStatics(const ExperimentSpec& experiment);

}  // namespace taut::cli
