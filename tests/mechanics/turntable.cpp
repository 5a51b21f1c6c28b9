/// Bodies that roll on moving ground.

#include "tests/mechanics/scene.h"
