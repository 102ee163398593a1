#include "capture/memory_needs.hpp"

#include <algorithm>
#include <utility>

#include "capture/format.hpp"

namespace nutik {
namespace {

double megabytes(std::uint64_t bytes) { return static_cast<double>(bytes) * 1e-6; }

std::string amount(std::uint64_t bytes) {
  return bytes < 100'000 ? format("{} bytes", bytes) : format("{:.4g} MB", megabytes(bytes));
}

std::string text_of(std::uint64_t allowed, const MemoryNeeds& least) {
  std::string text =
      format("{} of memory is too little; at least {} is needed", amount(allowed), amount(least.bytes()));
  std::vector<MemoryPart> parts = least.parts();
  std::ranges::stable_sort(parts, std::greater(), &MemoryPart::bytes);
  std::string before = ": ";
  for (const MemoryPart& part : parts) {
    if (part.bytes < least.bytes() / 100) break;  // these add up to nothing worth telling
    text += format("{}{} {:.3g} MB", std::exchange(before, ", "), part.what, megabytes(part.bytes));
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
    : UsageError(text_of(allowed, least),
                 Advice{format("; allow more: `memory {}MB`", least.bytes() / 1'000'000 + 1)}),
      needs(std::move(least)) {}

}  // namespace nutik
