/// Stiff and tight cables.

#include "tests/mechanics/scene.h"
