// Projects: the capture, the mask and the function file that make a picture, and how its regions look.
//
//   {"nutik-studio": 1, "capture": "clip.mp4", "functions": "throw.fn", "mask": "throw.pgm", …}
//
//   always:  mask and functions are the files that the command line reads. Paths are relative to the project's folder
//            where they can be. A save that was ended in the middle leaves the project as it was or as it was to be
#pragma once

#include <QString>
#include <QStringList>
#include <optional>
#include <string>

#include "features/recipe/picture_recipe.hpp"
#include "features/schema/command_id.hpp"
#include "media/formats/file_kinds.hpp"
#include "studio/document/document.hpp"

namespace nutik::studio {

// Where a document's mask and functions are; not used of a plain interval.
struct CommandFiles {
  QString mask, functions;
};

// The command line that makes a document's picture, one line for a POSIX shell, and the recipe that the picture
// carries: both come from one list of options, and nutik-cl writes the same bytes.
// `written`: options of how the picture is written.
[[nodiscard]] QString command_line(const Document& document, const CommandFiles& files,
                                   const QString& picture, const Stated& written = {});
// Reads both files. `command`: whose options were written.
[[nodiscard]] RecipeSources recipe_sources(const Document& document, const CommandFiles& files,
                                           const Stated& written = {}, CommandId command = CommandId::expose);

struct Project {
  QString capture;
  Stated stated;
  CommandFiles files;
  DocumentState state;
  Marks marks;
  std::int64_t duration_ns = 0;  // of the capture; 0: earlier versions do not say
  bool is_unwritten = false;  // functions and mask are not what its files hold
};

// Whether a path has no file of its own and stands for those of a folder: `frames/%04d.png`, `frames/*.png`.
[[nodiscard]] bool is_pattern(const QString& path);
// Where a project that has none yet gets its mask and functions: beside it, under names that are free or its own, and
// not its capture's.
[[nodiscard]] CommandFiles free_files_beside(const QString& project, const QString& capture = {});
// Those of them that are there and were not written for this project, under the name it has: they do not carry its
// mark, which is made of a random number in the project and of that name.
[[nodiscard]] QStringList foreign_files(const QString& project, const CommandFiles& files);
// Replaces what `files` names.
void save_project(const QString& path, const Document& document, const CommandFiles& files);
// The same in one file, which has functions and mask in it.
void keep_project(const QString& path, const Document& document);
// The name of the clip or capture that a project says it is of; empty: none.
[[nodiscard]] QString capture_name_in(const QString& path);
// Throws InputError that says what is wrong with which of its files.
[[nodiscard]] Project load_project(const QString& path);

// `mark` is a comment in the file.
void save_functions(const QString& path, const FunctionSet& functions, const QString& mark = {});
void save_mask(const QString& path, const Mask& mask, const QString& mark = {});
// Throw InputError as the command line's do.
[[nodiscard]] FunctionSet load_functions(const QString& path);
[[nodiscard]] Shared<MaskWithRegions> load_mask(const QString& path);

}  // namespace nutik::studio
