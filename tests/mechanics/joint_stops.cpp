/// Joints at their stops, fast hinges.

#include "tests/mechanics/scene.h"
