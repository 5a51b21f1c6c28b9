#include "trace/hdf5.h"

#include <algorithm>
#include <string_view>

namespace taut::trace {
namespace {

herr_t TakeInnermost(unsigned depth, const H5E_error2_t* error, void* out) {
  if (depth == 0 && error->desc != nullptr) *static_cast<std::string*>(out) = error->desc;
  return 0;
}

/// Callback of HDF5 after a failed call. Stores the reason before later calls overwrite it.
herr_t Remember(hid_t stack, void* out) {
  Hdf5Failure& first = *static_cast<Hdf5Failure*>(out);
  if (!first.why.empty()) return 0;
  H5Ewalk2(stack, H5E_WALK_UPWARD, TakeInnermost, &first.why);
  constexpr std::string_view kQuote = "error message = '";
  if (const std::size_t at = first.why.find(kQuote); at != first.why.npos) {
    const std::size_t from = at + kQuote.size();
    first = {first.why.substr(from, first.why.find('\'', from) - from), true};
  }
  return 0;
}

}  // namespace

QuietHdf5::QuietHdf5() {
  // A trace that could not be finished remains open inside the library. Prevent the library from
  // closing it again when the program exits.
  static const herr_t once = H5dont_atexit();
  static_cast<void>(once);
  H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
  H5Eset_auto2(H5E_DEFAULT, Remember, &first_);
}

QuietHdf5::~QuietHdf5() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }

Hdf5Id StringType(std::size_t size) {
  Hdf5Id type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, std::max<std::size_t>(size, 1));
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return type;
}

std::string WhyElsewhere(hid_t plan) {
  if (plan >= 0 && H5Pget_layout(plan) == H5D_VIRTUAL) return "is a virtual dataset";
  if (plan < 0 || H5Pget_external_count(plan) != 0) return "stores its numbers in another file";
  return {};
}

Hdf5Id OpenDataset(hid_t file, const std::string& name, std::string& error) {
  // Check each part of the path, since a soft link may lead to an external link.
  for (std::size_t end = name.find('/', 1);; end = name.find('/', end + 1)) {
    const std::string part = name.substr(0, end);
    H5L_info_t link{};
    if (H5Lget_info(file, part.c_str(), &link, H5P_DEFAULT) < 0) {
      error = "the file has no dataset " + name;
      return {};
    }
    if (link.type != H5L_TYPE_HARD) {
      error = part + (link.type == H5L_TYPE_SOFT ? " is a soft link; name the dataset itself"
                                                 : " is a link to another file");
      return {};
    }
    if (end == std::string::npos) break;
  }
  Hdf5Id object(H5Oopen(file, name.c_str(), H5P_DEFAULT), H5Oclose);
  if (!object || H5Iget_type(object) != H5I_DATASET) {
    error = name + " is not a dataset";
    return {};
  }
  const Hdf5Id plan(H5Dget_create_plist(object), H5Pclose);
  const std::string why = WhyElsewhere(plan);
  if (why.empty()) return object;
  error = name + " " + why;
  return {};
}

}  // namespace taut::trace
