// Stub without libpng, for the browser build.
#include "description/assets/height_image.h"

namespace taut::description {

std::optional<HeightImage> ReadHeightImage(const std::string& path, double /*most*/,
                                           Diagnostics& out) {
  out.Error("browser.no_images", {path, 0, 0}, "images of the ground cannot be read in a browser",
            "the command taut reads them; `height_m` takes a formula, `file` a .csv");
  return std::nullopt;
}

}  // namespace taut::description
