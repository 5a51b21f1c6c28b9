// Stub without libpng, for the browser build.
#include "description/assets/height_image.h"

namespace taut::description {

std::optional<HeightImage> ReadHeightImage(const std::string& path, trace::TableBudget& /*budget*/,
                                           Diagnostics& out) {
  out.Error("browser.no_images", {path, 0, 0}, "images of heights cannot be read in a browser",
            "use a formula in `height_m`, a .csv in `file`, or the command-line program taut");
  return std::nullopt;
}

}  // namespace taut::description
