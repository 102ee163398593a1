// Options of a command as fields: names, choices and tips are the schema's, and so is what is refused.
#pragma once

#include <QString>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "features/schema/command_id.hpp"
#include "features/schema/options.hpp"
#include "studio/document/document.hpp"

class QWidget;

namespace nutik::studio {

// Whether a person says yes; the question is no HTML, whatever the files in it are called.
[[nodiscard]] bool is_wanted(QWidget* parent, const QString& title, const QString& question);

// As a command line states them. Throws UsageError.
[[nodiscard]] Options options_in(CommandId command, const Stated& stated);

struct Wanted {
  QString path;  // of the file to write; empty where none is asked for
  Stated options;
};

struct Asked {
  CommandId command;
  QString title;
  std::vector<const char*> options;
  Wanted first;    // what the fields begin with
  QString filter;  // of files, for a file dialog
  // Throws where it cannot be done, which is said in the dialog; may be empty.
  std::function<void(const Wanted& wanted, const Options& options)> check;
  QString why = {};  // it is asked; over the fields
  std::map<std::string, QString> words = {};  // for choices; by an option's name where nothing is chosen
};
// None where a person gave it up; what else was stated stays. A name without an ending gets that of the first one; what
// is there is replaced if a person says so.
[[nodiscard]] std::optional<Wanted> ask_options(QWidget* parent, const Asked& asked);

}  // namespace nutik::studio
