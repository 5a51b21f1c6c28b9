/// Names of results of a fit, used by all output formats.
#pragma once

#include <string>

#include "taut/identify.h"

namespace taut::identify {

const char* WordOf(FitJudgement judgement);
/// Returns name and unit as text, such as "push_n [N]".
std::string WithUnit(const std::string& name, const std::string& unit);
/// Returns the result of the check of carried loads as a sentence.
std::string CarriedText(const Identification& fit, const CarriedLoad& carried);
/// Returns a number with five digits as text; "-" if it is not finite.
std::string FiveDigits(double x);
/// Returns a standard error as text; "any" if it is infinite.
std::string ErrorText(double se);

}  // namespace taut::identify
