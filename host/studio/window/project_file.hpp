// Projects: the capture, the mask and the function file that make a picture, and how its regions look.
//
//   {"nutik-studio": 1, "capture": "clip.mp4", "functions": "throw.fn", "mask": "throw.pgm", …}
//
//   always:  mask and functions are the files that the command line reads. Paths are relative to the project's folder
//            where they can be; each file is written whole or not at all
#pragma once

#include <QString>
#include <optional>

#include "studio/document/document.hpp"
#include "studio/window/command_line.hpp"

namespace nutik::studio {

struct Project {
  QString capture;
  QString rate;  // stated; empty: what the clip says
  CommandFiles files;
  DocumentState state;
};

inline constexpr const char* kProjectExtension = ".nutik";

// A project's mask and functions where it names none: beside it.
[[nodiscard]] CommandFiles files_beside(const QString& project);
void save_project(const QString& path, const Document& document, const CommandFiles& files);
// The same in one file, which has functions and mask in it.
void keep_project(const QString& path, const Document& document);
// The name of the clip or capture that a project says it is of; empty: none.
[[nodiscard]] QString capture_name_in(const QString& path);
// Throws InputError that says what is wrong with which of its files.
[[nodiscard]] Project load_project(const QString& path);

void save_functions(const QString& path, const FunctionSet& functions);
void save_mask(const QString& path, const Mask& mask);
// Throw InputError as the command line's do.
[[nodiscard]] FunctionSet load_functions(const QString& path);
[[nodiscard]] Shared<MaskWithRegions> load_mask(const QString& path);

}  // namespace nutik::studio
