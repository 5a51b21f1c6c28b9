/// What NTRT's builder makes of a structure: solids, bodies, cables and where these end. NTRT's
/// frame and the files' units.
#pragma once

#include <vector>

#include "import_ntrt/structure.h"

namespace taut::import_ntrt {

struct Solid {
  int builder = 0;
  int pair = -1;           ///< Of a rod or box; -1 of a sphere.
  int node = -1;           ///< Of a sphere: the one that says so.
  int from = -1, to = -1;  ///< Nodes, as in `Built::same`; of a sphere both are its centre.
  int body = 0;
  double mass_kg = 0.0;
};

/// How an end of a cable can be said in a model.
enum class End {
  kNode,     ///< At its node.
  kSurface,  ///< On the sphere there, or else on the rod with the nearest centre.
  kPoint,    ///< Elsewhere on its solid, by a rule that models do not have.
};
struct CableEnd {
  int node = 0;
  int body = 0;
  End kind = End::kNode;
  Vec3 point;
};
struct Cable {
  int builder = 0, pair = 0;
  CableEnd from, to;
  double rest_length = 0.0;
};

struct Built {
  std::vector<int> same;  ///< Per node: the first in its place, which stands for all there.
  std::vector<Solid> solids;
  std::vector<Cable> cables;
  std::vector<int> bodies_solids;  ///< Per body: how many.
  std::vector<double> mass_kg;     ///< Per body; 0: it stands still.
};

/// Complains about what NTRT would not build.
Built BuildStructure(Model& model, Diagnostics& out);

}  // namespace taut::import_ntrt
