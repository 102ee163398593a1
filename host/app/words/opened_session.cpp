#include "app/words/stated_requests.hpp"

#include <malloc.h>

#include <utility>

#include "app/output/console.hpp"
#include "app/output/progress.hpp"
#include "capture/error.hpp"
#include "capture/format.hpp"
#include "features/schema/option.hpp"
#include "features/schema/requests.hpp"
#include "system/input_bytes.hpp"

namespace nutik::app {
namespace {

// A .tik was described when it was made.
void refuse_source_options(const Options& options, const std::string& capture) {
  for (const Option& option : schema()) {
    const bool is_off = option.setting == Setting::between && !options.source.between;
    if (!option.describes_clip() || !option.is_in(options) || is_off) continue;
    throw UsageError(format("{} describes a clip that is encoded; {} was encoded already. {}", option.name(),
                            capture,
                            option.is_of(CommandId::retime)
                                ? format("To correct it: nutik-cl retime {} … {} NEW.tik", option.name(), capture)
                                : "Encode the clip again with it"));
  }
}

}  // namespace

SourceRequest source_request(const Options& options, const std::string& name) {
  // Standard input is looked at by the session, once all else that may be wrong is known.
  if (is_standard_input(name) || !is_tik(name)) return clip_request(options, name);
  refuse_source_options(options, name);
  SourceRequest request;
  request.path = name;
  request.clip.transfer = options.source.clip.transfer;
  return request;
}

MemoryBudget memory_budget(const Options& options) {
#ifdef __GLIBC__
  // Freed memory goes back to the system soon, which is slower than keeping it for the next time, for all of the
  // process. Blocks from this size on are mapped, each for itself, and unmapped when they are freed. Otherwise the
  // limit grows to 32 MiB with what is freed, and pictures leave holes in heaps.
  constexpr int kMappedFrom = 1 << 20;
  if (options.memory) {
    mallopt(M_MMAP_THRESHOLD, kMappedFrom);
    mallopt(M_TRIM_THRESHOLD, 2 * kMappedFrom);
  }
#endif
  return options.memory.value_or(MemoryBudget::of_machine());
}

std::shared_ptr<Devices> make_devices(const Options& options) {
  static_cast<void>(memory_budget(options));
  return std::make_shared<Devices>(computing_request(options),
                                   options.quiet ? Devices::Announce() : Devices::Announce(print_note));
}

Session open_session(const Options& options, Session::Terms terms, const char* what) {
  const std::shared_ptr<Devices> devices = make_devices(options);
  devices->start();
  return open_session(options.operands.front(), options, devices, std::move(terms), what);
}

Session open_session(const std::string& name, const Options& options, std::shared_ptr<Devices> devices,
                     Session::Terms terms, const char* what) {
  terms.progress = [before = std::move(terms.progress),
                    bar = progress_bar(what, options.quiet,
                                       options.progress ? ProgressLines::before : ProgressLines::none)](
                       std::uint64_t done, std::uint64_t total) {
    if (before) before(done, total);
    if (bar) bar(done, total);
  };
  Session session(source_request(options, name), std::move(devices), terms);
  print_warnings(session.warnings());
  return session;
}

std::vector<std::string> camera_notes(const std::optional<MovedCamera>& moved) {
  if (!moved) return {};
  return {
      format("{}; --align rigid moves the clip's pictures back when it is read or encoded", moved->text())};
}

}  // namespace nutik::app
