// A capture that can be read more than once and from any place on: for commands that expose it many times
// or look at all of it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/command_line/options.hpp"
#include "tik/reader.hpp"

namespace nutik::app {

class OpenedCapture {
 public:
  // A .tik is opened. A clip is encoded into a temporary file (in TMPDIR, else /tmp) first, with a progress
  // bar; that file has no name any more when this returns and takes no space when the capture is closed.
  // Throws UsageError where options describe a clip and `name` is a .tik, InputError where it cannot be
  // read, OutputError where there is no space for the temporary file.
  OpenedCapture(const std::string& name, const Options& options);

  [[nodiscard]] tik::Reader& reader() { return *reader_; }
  // On a clip, what its timing was taken from, and what else to know: whole lines. Empty for a .tik.
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

 private:
  std::unique_ptr<tik::Reader> reader_;
  std::vector<std::string> notes_;
};

}  // namespace nutik::app
