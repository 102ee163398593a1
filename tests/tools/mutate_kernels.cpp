// Preloaded before an OpenCL program: replaces one text of its kernels' sources by another before they are built, so
// that it can be seen whether tests notice (tools/mutate kernels).
//
//   NUTIK_MUTATE_FROM   a text that a source has at most once
//   NUTIK_MUTATE_TO     what to put in its place
//
// Says `mutated` on stderr for each source that had the text.
#include <CL/cl.h>
#include <dlfcn.h>

#include <cstdio>
#include <cstdlib>
#include <string>

namespace {

std::string setting(const char* name) {
  const char* text = std::getenv(name);
  if (text == nullptr) {
    std::fprintf(stderr, "%s is not set\n", name);
    std::abort();
  }
  return text;
}

std::string joined(cl_uint count, const char** strings, const std::size_t* lengths) {
  std::string source;
  for (cl_uint i = 0; i < count; ++i) {
    const bool has_length = lengths != nullptr && lengths[i] != 0;
    source += has_length ? std::string(strings[i], lengths[i]) : std::string(strings[i]);
  }
  return source;
}

}  // namespace

extern "C" cl_program clCreateProgramWithSource(cl_context context, cl_uint count, const char** strings,
                                                const std::size_t* lengths, cl_int* error) {
  std::string source = joined(count, strings, lengths);
  const std::string from = setting("NUTIK_MUTATE_FROM");
  if (const std::size_t at = source.find(from); at != std::string::npos) {
    if (source.find(from, at + 1) != std::string::npos) {
      std::fprintf(stderr, "'%s' is not the only one\n", from.c_str());
      std::abort();
    }
    source.replace(at, from.size(), setting("NUTIK_MUTATE_TO"));
    std::fprintf(stderr, "mutated\n");
  }
  using Create = decltype(&clCreateProgramWithSource);
  const auto create = reinterpret_cast<Create>(dlsym(RTLD_NEXT, "clCreateProgramWithSource"));
  const char* text = source.c_str();
  const std::size_t length = source.size();
  return create(context, 1, &text, &length, error);
}
