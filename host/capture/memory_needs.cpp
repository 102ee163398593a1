#include "capture/memory_needs.hpp"

#include <unistd.h>

#include <algorithm>
#include <utility>

#include "capture/format.hpp"

namespace nutik {
namespace {

std::string amount(std::uint64_t bytes, int digits = 4) {
  if (bytes < 100'000) return format("{} bytes", bytes);
  const bool is_large = bytes >= 999'500'000;  // else 1000 of the smaller unit
  const double amount = static_cast<double>(bytes) * (is_large ? 1e-9 : 1e-6);
  const std::string number = amount < 1000 ? format("{:.{}g}", amount, digits) : format("{:.0f}", amount);
  return number + (is_large ? " GB" : " MB");
}

Advice way_out(std::uint64_t least) {
  if (least <= machine_memory()) return {format("; allow more: `memory {}MB`", least / 1'000'000 + 1)};
  return {format("; this machine has {}: encode a clip before it is exposed, or take fewer pixels (`scale`) or "
                 "pictures",
                 amount(machine_memory()))};
}

std::string text_of(std::uint64_t allowed, const MemoryNeeds& least) {
  std::string text =
      format("{} of memory is too little; at least {} is needed", amount(allowed), amount(least.bytes()));
  std::vector<MemoryPart> parts = least.parts();
  std::ranges::stable_sort(parts, std::greater(), &MemoryPart::bytes);
  std::string before = ": ";
  for (const MemoryPart& part : parts) {
    if (part.bytes < least.bytes() / 100) break;  // these add up to nothing worth telling
    text += format("{}{} {}", std::exchange(before, ", "), part.what, amount(part.bytes, 3));
  }
  return text;
}

}  // namespace

void MemoryNeeds::add(const std::string& what, std::uint64_t bytes) {
  const auto same = std::ranges::find(parts_, what, &MemoryPart::what);
  if (same == parts_.end()) {
    parts_.push_back({what, bytes});
  } else {
    same->bytes += bytes;
  }
}

void MemoryNeeds::add(const MemoryNeeds& others) {
  for (const MemoryPart& part : others.parts_) add(part.what, part.bytes);
}

std::uint64_t MemoryNeeds::bytes() const {
  std::uint64_t bytes = 0;
  for (const MemoryPart& part : parts_) bytes += part.bytes;
  return bytes;
}

std::uint64_t MemoryNeeds::rest_of(std::uint64_t allowed) const {
  if (bytes() > allowed) throw MemoryTooLittle(allowed, *this);
  return allowed - bytes();
}

MemoryTooLittle::MemoryTooLittle(std::uint64_t allowed, MemoryNeeds least)
    : UsageError(text_of(allowed, least), way_out(least.bytes())), needs(std::move(least)) {}

std::uint64_t machine_memory() {
  return static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES)) * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

}  // namespace nutik
