// Dark, light, or as the system has it. Neutral greys, so that nothing tints what is seen.
#pragma once

#include <QString>

namespace nutik::studio {

enum class Appearance { dark, light, system };

void set_appearance(Appearance appearance);
// What was chosen last; dark at first.
[[nodiscard]] Appearance kept_appearance();
void keep_appearance(Appearance appearance);

}  // namespace nutik::studio
