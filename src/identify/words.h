/// What outcomes are called, in all of their forms.
#pragma once

#include <string>

#include "taut/identify.h"

namespace taut::identify {

const char* WordOf(Determined kind);
const char* WordOf(FitJudgement judgement);
/// "push_n [N]".
std::string WithUnit(const std::string& name, const std::string& unit);
/// What a question about carried loads came to, in a sentence.
std::string CarriedText(const Identification& fit, const CarriedLoad& carried);
/// "any" if it is infinite.
std::string ErrorText(double se);

}  // namespace taut::identify
