// What libraries throw. A message says what is wrong, where, what the limit is and what to do about it;
// the program's main() alone prints it and turns its class into an exit status.
#pragma once

#include <stdexcept>

namespace nutik {

struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// The request itself makes no sense: options that contradict each other, an unknown name.
struct UsageError : Error {
  using Error::Error;
};

// Something that was read is wrong: a clip, a .tik, a mask, a function file.
struct InputError : Error {
  using Error::Error;
};

// The OpenCL device cannot do it: absent, too small, a failed build.
struct DeviceError : Error {
  using Error::Error;
};

// The result cannot be written.
struct OutputError : Error {
  using Error::Error;
};

// Whoever asked does not want the result any more.
struct Cancelled : Error {
  Cancelled() : Error("it was cancelled") {}
};

}  // namespace nutik
