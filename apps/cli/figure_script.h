/// Text of python/taut/plot.py, which the build inserts (figure_script.cpp.in).
#pragma once

namespace taut::cli {

extern const char* const kFigureScript;

}  // namespace taut::cli
