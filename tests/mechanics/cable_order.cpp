/// Order of cables in a file.

#include "tests/mechanics/scene.h"
