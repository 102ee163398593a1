#include "render/table_memory.hpp"

#include "render/gain_table.hpp"

namespace nutik {

std::uint64_t TableMemory::new_table() {
  const std::scoped_lock lock(mutex_);
  return tables_++;
}

std::shared_ptr<const TableRun> TableMemory::find(std::uint64_t table, std::size_t run) {
  const std::scoped_lock lock(mutex_);
  const auto place = places_.find({table, run});
  if (place == places_.end()) return nullptr;
  recent_.splice(recent_.begin(), recent_, place->second);
  return place->second->run;
}

void TableMemory::keep(std::uint64_t table, std::size_t run, std::shared_ptr<const TableRun> made) {
  const std::scoped_lock lock(mutex_);
  ++runs_made_;
  const std::pair key(table, run);
  if (places_.contains(key)) return;  // another thread made it meanwhile
  bytes_ += made->bytes();
  recent_.push_front({key, std::move(made)});
  places_.emplace(key, recent_.begin());
  while (bytes_ > max_bytes_) drop(std::prev(recent_.end()));
}

void TableMemory::forget(std::uint64_t table) {
  const std::scoped_lock lock(mutex_);
  for (auto place = places_.lower_bound({table, 0}); place != places_.end() && place->first.first == table;) {
    drop((place++)->second);
  }
}

void TableMemory::drop(std::list<Kept>::iterator kept) {
  bytes_ -= kept->run->bytes();
  places_.erase(kept->key);
  recent_.erase(kept);
}

std::uint64_t TableMemory::bytes() const {
  const std::scoped_lock lock(mutex_);
  return bytes_;
}

std::uint64_t TableMemory::runs_made() const {
  const std::scoped_lock lock(mutex_);
  return runs_made_;
}

}  // namespace nutik
