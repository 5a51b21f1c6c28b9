/// Cables that touch free rods.

#include "tests/mechanics/scene.h"
