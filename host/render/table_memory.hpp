// Keeps parts of gain tables between exposures, the ones used last, as many as a budget allows.
//
//   threads: safe from any number
#pragma once

#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <utility>

namespace nutik {

struct TableRun;

class TableMemory {
 public:
  explicit TableMemory(std::uint64_t max_bytes) : max_bytes_(max_bytes) {}

  // A number for a table, of its own.
  [[nodiscard]] std::uint64_t new_table();
  // A run of a table; null if it was never made, or was dropped since.
  [[nodiscard]] std::shared_ptr<const TableRun> find(std::uint64_t table, std::size_t run);
  // Keeps a run that was made, and drops those that were not used for longest. Whoever still has one goes on having it.
  void keep(std::uint64_t table, std::size_t run, std::shared_ptr<const TableRun> made);
  // The table is gone.
  void forget(std::uint64_t table);

  [[nodiscard]] std::uint64_t bytes() const;
  // Runs that were made so far, those that had been dropped again.
  [[nodiscard]] std::uint64_t runs_made() const;

 private:
  struct Kept {
    std::pair<std::uint64_t, std::size_t> key;
    std::shared_ptr<const TableRun> run;
  };
  void drop(std::list<Kept>::iterator kept);

  mutable std::mutex mutex_;
  std::uint64_t max_bytes_;
  std::uint64_t bytes_ = 0;
  std::uint64_t tables_ = 0;
  std::uint64_t runs_made_ = 0;
  std::list<Kept> recent_;  // the one used last first
  std::map<std::pair<std::uint64_t, std::size_t>, std::list<Kept>::iterator> places_;
};

}  // namespace nutik
