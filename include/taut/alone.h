/// Deprecated name of minimal_experiment.h; the next release removes it.
#pragma once

#include "taut/minimal_experiment.h"
