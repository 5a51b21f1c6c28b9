/// Visit of all links of an HDF5 file, in time linear in the number of groups.
#pragma once

#include <functional>
#include <string>

#include "trace/hdf5.h"

namespace taut::trace {

struct Hdf5Link {
  const std::string& path;  ///< Without a slash at the start: "cable/a/tension_n".
  H5L_type_t type;
  Hdf5Id object;  ///< Of hard links; others are not followed.
};

enum class Hdf5Visit { kContinue, kSkipGroup, kFail };

/// Calls `visit` for each link, by name, and for the links of a group after the group. A group with
/// several links is entered once. Returns false if a call returned kFail, or if the file is damaged
/// or its groups are nested too deeply; `error` is set unless `visit` failed or HDF5 reported the
/// reason. H5Lvisit would pass the path from the root, and opening each of n nested groups by this
/// path takes n^2 / 2 steps.
bool VisitLinks(hid_t file, const std::function<Hdf5Visit(Hdf5Link&)>& visit, std::string& error);

}  // namespace taut::trace
