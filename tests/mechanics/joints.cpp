/// Bodies on joints: spin, loops, redundant rows.

#include "tests/mechanics/scene.h"
