// What a validation came to, for people and for scripts.
#pragma once

#include <string>

#include "app/output/report.hpp"
#include "session/clips/source_check.hpp"
#include "session/session.hpp"

namespace nutik::app {

[[nodiscard]] std::string format_name(ValueType type);  // `8-bit codes`, `floats`

// A row for each arithmetic, and one for the reference; what `auto` takes has a star.
[[nodiscard]] std::string variants_text(const Validation& validation);
// What `auto` takes, and how right that is sure to be.
[[nodiscard]] std::string choice_text(const Validation& validation);
[[nodiscard]] std::string source_text(const SourceCheck& check, const Shape& shape, const std::string& clip);

[[nodiscard]] Json variants_json(const Validation& validation, const Shape& shape);
[[nodiscard]] Json source_json(const SourceCheck& check, const Shape& shape, const std::string& clip);

}  // namespace nutik::app
