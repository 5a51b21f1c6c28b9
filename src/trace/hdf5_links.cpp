#include "trace/hdf5_links.h"

#include <fmt/format.h>

#include <set>
#include <utility>
#include <vector>

namespace taut::trace {
namespace {

/// Bounds the recursion. Programs nest groups at most some ten times.
constexpr int kMostGroups = 1000;

using Links = std::vector<std::pair<std::string, H5L_type_t>>;

herr_t NoteLink(hid_t, const char* name, const H5L_info_t* link, void* links) {
  static_cast<Links*>(links)->emplace_back(name, link->type);
  return 0;
}

class LinkVisit {
 public:
  LinkVisit(const std::function<Hdf5Visit(Hdf5Link&)>& visit, std::string& error)
      : visit_(visit), error_(error) {}

  /// `path`: path of the group with a slash at its end; empty for the root.
  bool Group(hid_t group, const std::string& path, int depth) {
    if (depth > kMostGroups) {
      error_ = fmt::format("more than {} groups are nested", kMostGroups);
      return false;
    }
    if (!IsNew(group)) return true;
    Links links;
    if (H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, nullptr, NoteLink, &links) < 0) return false;
    for (const auto& [name, type] : links) {
      const std::string at = path + name;
      Hdf5Link link{at, type, {}};
      if (type == H5L_TYPE_HARD) {
        link.object = Hdf5Id(H5Oopen(group, name.c_str(), H5P_DEFAULT), H5Oclose);
        if (!link.object) return false;
      }
      const bool is_group = link.object && H5Iget_type(link.object) == H5I_GROUP;
      const Hdf5Visit next = visit_(link);
      if (next == Hdf5Visit::kFail) return false;
      if (!is_group || next == Hdf5Visit::kSkipGroup) continue;
      if (!Group(link.object, at + "/", depth + 1)) return false;
    }
    return true;
  }

 private:
  /// Links can lead back to a group.
  bool IsNew(hid_t group) {
    H5O_info_t info{};
#if H5_VERSION_GE(1, 12, 0)
    if (H5Oget_info(group, &info, H5O_INFO_BASIC) < 0) return true;
    const auto& bytes = info.token.__data;
    return entered_.emplace(std::begin(bytes), std::end(bytes)).second;
#else
    if (H5Oget_info(group, &info) < 0) return true;
    return entered_.insert(info.addr).second;
#endif
  }

  const std::function<Hdf5Visit(Hdf5Link&)>& visit_;
  std::string& error_;
#if H5_VERSION_GE(1, 12, 0)
  std::set<std::vector<unsigned char>> entered_;
#else
  std::set<haddr_t> entered_;
#endif
};

}  // namespace

bool VisitLinks(hid_t file, const std::function<Hdf5Visit(Hdf5Link&)>& visit, std::string& error) {
  return LinkVisit(visit, error).Group(file, "", 0);
}

}  // namespace taut::trace
