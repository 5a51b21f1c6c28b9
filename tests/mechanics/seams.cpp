/// Ground of several pieces.

#include "tests/mechanics/scene.h"
