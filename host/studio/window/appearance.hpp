// Dark, light, or as the system has it, in neutral greys, so that nothing tints what is seen; and in which language.
#pragma once

#include <QStringList>

namespace nutik::studio {

enum class Appearance { dark, light, system };

void set_appearance(Appearance appearance);
// What was chosen last; dark at first.
[[nodiscard]] Appearance kept_appearance();
void keep_appearance(Appearance appearance);

// The first of a person's languages, `de-DE`, that the window speaks, its standard buttons too if Qt's translations are
// installed; else English.
void use_language(const QStringList& languages);

}  // namespace nutik::studio
