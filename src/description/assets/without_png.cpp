// Where there is no libpng: in a browser.
#include "description/assets/height_image.h"

namespace taut::description {

std::optional<HeightImage> ReadHeightImage(const std::string& path, double /*most*/,
                                           Diagnostics& out) {
  out.Error({path, 0, 0}, "images of the ground cannot be read in a browser",
            "the command taut reads them; `height_m` takes a formula, `file` a .csv");
  return std::nullopt;
}

}  // namespace taut::description
