#include "tests/solver/law_lanes.h"

namespace taut::test {

AskContactsFunction* const kAskFourContacts = AskContacts<simd::Wide<4>>;
AskCablesFunction* const kAskFourCables = AskCables<simd::Wide<4>>;

}  // namespace taut::test
