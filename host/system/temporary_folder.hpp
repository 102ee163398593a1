// Where files lie that nobody keeps, and such files.
#pragma once

#include <filesystem>

namespace nutik {

// The one that TMPDIR names, else /tmp. Throws OutputError where that is no folder.
[[nodiscard]] std::filesystem::path temporary_folder();

// An empty file in temporary_folder() without a name: however the process ends, nothing of it is left.
class NamelessFile {
 public:
  // Throws OutputError where none can be made.
  NamelessFile();
  ~NamelessFile();
  NamelessFile(const NamelessFile&) = delete;
  NamelessFile& operator=(const NamelessFile&) = delete;

  [[nodiscard]] int descriptor() const { return descriptor_; }
  // By which this process can open it again, as long as this lives.
  [[nodiscard]] std::filesystem::path path() const;

 private:
  int descriptor_;
};

}  // namespace nutik
