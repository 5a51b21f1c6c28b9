#include "tests/solver/law_lanes.h"

namespace taut::test {

AskContactsFunction* const kAskEightContacts = AskContacts<simd::Wide<8>>;
AskCablesFunction* const kAskEightCables = AskCables<simd::Wide<8>>;

}  // namespace taut::test
