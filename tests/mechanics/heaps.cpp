/// Slabs and heaps of rods.

#include "tests/mechanics/scene.h"
