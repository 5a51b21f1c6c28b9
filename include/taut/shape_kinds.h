/// Iteration over all shapes of a model, independent of their kinds.
///
/// Pure functions; thread safe for different models. docs/extending.md lists the other files to
/// change for a new kind.
#pragma once

#include "taut/model_def.h"

namespace taut {

/// Name of a kind of shape for messages and tables.
struct ShapeName {
  const char* one;
  const char* many;
};

/// Calls f(name, list of the first model, list of the second one, ...) for each kind of shape.
/// `Defs`: ModelDef, const or not.
template <class F, class... Defs>
void EachShapeList(F f, Defs&... defs) {
  f(ShapeName{"sphere", "spheres"}, defs.spheres...);
  f(ShapeName{"rod", "rods"}, defs.capsules...);
  f(ShapeName{"box", "boxes"}, defs.boxes...);
  f(ShapeName{"hull", "hulls"}, defs.hulls...);
}

/// Calls f(shape) for each shape of a model.
template <class Def, class F>
void EachShape(Def& def, F f) {
  const auto each = [&f](const ShapeName&, auto& shapes) {
    for (auto& shape : shapes) f(shape);
  };
  EachShapeList(each, def);
}

// EachPoint: calls f(point), by reference, for each point [m], in W, that defines the position of a
// shape.
template <class F>
void EachPoint(SphereDef& sphere, F f) {
  f(sphere.center_m);
}
template <class F>
void EachPoint(CapsuleDef& rod, F f) {
  f(rod.from_m), f(rod.to_m);
}
template <class F>
void EachPoint(BoxDef& box, F f) {
  f(box.center_m);
}
template <class F>
void EachPoint(HullDef& hull, F f) {
  for (Vec3& corner : hull.corners_m) f(corner);
}

}  // namespace taut
