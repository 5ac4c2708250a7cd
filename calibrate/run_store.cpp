// SPDX-FileCopyrightText: 2026 The Tilth authors
// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/run_store.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "calibrate/config_error.hpp"

namespace tilth {
namespace {

constexpr int format_version = 1;
constexpr int busy_timeout_ms = 60'000;

constexpr const char* schema = R"(
CREATE TABLE IF NOT EXISTS runs (
  key TEXT PRIMARY KEY, solver TEXT NOT NULL, test TEXT NOT NULL, condition TEXT NOT NULL,
  seed INTEGER NOT NULL, setup TEXT NOT NULL, material TEXT NOT NULL, state TEXT NOT NULL,
  reason TEXT NOT NULL, num_tries INTEGER NOT NULL, dt_s REAL, num_steps INTEGER,
  inertial_number REAL, wall_s REAL, host TEXT,
  num_repeats INTEGER NOT NULL DEFAULT 0, added TEXT DEFAULT CURRENT_TIMESTAMP);
CREATE TABLE IF NOT EXISTS features (
  key TEXT NOT NULL REFERENCES runs(key) ON DELETE CASCADE, position INTEGER NOT NULL,
  name TEXT NOT NULL, value REAL, PRIMARY KEY (key, position)) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS curves (
  key TEXT NOT NULL REFERENCES runs(key) ON DELETE CASCADE, position INTEGER NOT NULL,
  name TEXT NOT NULL, columns TEXT NOT NULL, rows BLOB NOT NULL, PRIMARY KEY (key, position));
)";

RunState state_from(const std::string& word) {
  for (const RunState s : {RunState::completed, RunState::failed, RunState::abandoned})
    if (word == to_string(s)) return s;
  throw std::runtime_error("unknown state " + word);
}

/// Rows one after the other as doubles of this machine (little-endian on every Debian we build on).
std::string packed(const NamedTable& table) {
  std::string bytes;
  bytes.reserve(table.rows.size() * table.columns.size() * sizeof(double));
  for (const auto& row : table.rows)
    bytes.append(reinterpret_cast<const char*>(row.data()), row.size() * sizeof(double));
  return bytes;
}

std::vector<std::vector<double>> unpacked(const std::string& bytes, std::size_t num_columns) {
  std::vector<std::vector<double>> rows;
  const std::size_t row_bytes = num_columns * sizeof(double);
  for (std::size_t at = 0; row_bytes > 0 && at + row_bytes <= bytes.size(); at += row_bytes) {
    std::vector<double> row(num_columns);
    std::memcpy(row.data(), bytes.data() + at, row_bytes);
    rows.push_back(std::move(row));
  }
  return rows;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& w : words) text += (text.empty() ? "" : ",") + w;
  return text;
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> words;
  for (std::size_t at = 0; !text.empty() && at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    words.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return words;
}

}  // namespace

struct RunStore::Impl {
  std::filesystem::path file;
  SQLite::Database db;

  Impl(const std::filesystem::path& f, int flags) : file(f), db(f.string(), flags, busy_timeout_ms) {}

  [[noreturn]] void fail(const SQLite::Exception& e) const {
    throw std::runtime_error(fmt::format("{}: {}; the runs written before are safe", file.string(),
                                         e.what()));
  }

  void write(const RunRecord& r) {
    SQLite::Statement run(db, R"(
INSERT INTO runs (key, solver, test, condition, seed, setup, material, state, reason, num_tries,
                  dt_s, num_steps, inertial_number, wall_s, host)
VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?))");
    int k = 0;
    for (const std::string& text : {r.key, r.identity.solver, r.identity.test, r.identity.condition})
      run.bind(++k, text);
    run.bind(++k, static_cast<std::int64_t>(r.identity.seed));
    for (const std::string& text : {r.identity.setup, r.identity.material,
                                    std::string(to_string(r.state)), r.reason})
      run.bind(++k, text);
    run.bind(++k, r.num_tries);
    run.bind(++k, r.dt_s);
    run.bind(++k, r.num_steps);
    run.bind(++k, r.inertial_number);
    run.bind(++k, r.wall_s);
    run.bind(++k, r.host);
    run.exec();
    write_features(r);
    write_curves(r);
  }

  void write_features(const RunRecord& r) {
    SQLite::Statement feature(db, "INSERT INTO features VALUES (?, ?, ?, ?)");
    for (std::size_t k = 0; k < r.features.size(); ++k) {
      feature.reset();
      feature.bind(1, r.key);
      feature.bind(2, static_cast<std::int64_t>(k));
      feature.bind(3, r.features[k].name);
      if (std::isnan(r.features[k].value)) feature.bind(4);  // NULL: SQLite has no NaN
      else feature.bind(4, r.features[k].value);
      feature.exec();
    }
  }

  void write_curves(const RunRecord& r) {
    SQLite::Statement curve(db, "INSERT INTO curves VALUES (?, ?, ?, ?, ?)");
    for (std::size_t k = 0; k < r.curves.size(); ++k) {
      const std::string bytes = packed(r.curves[k]);
      curve.reset();
      curve.bind(1, r.key);
      curve.bind(2, static_cast<std::int64_t>(k));
      curve.bind(3, r.curves[k].name);
      curve.bind(4, joined(r.curves[k].columns));
      curve.bind(5, bytes.data(), static_cast<int>(bytes.size()));
      curve.exec();
    }
  }

  std::optional<RunState> stored_state(const std::string& key) const {
    SQLite::Statement query(db, "SELECT state FROM runs WHERE key = ?");
    query.bind(1, key);
    if (!query.executeStep()) return std::nullopt;
    return state_from(query.getColumn(0));
  }

  void add_one(const RunRecord& r) {
    const auto before = stored_state(r.key);
    if (before && *before != RunState::failed) {
      SQLite::Statement repeat(db, "UPDATE runs SET num_repeats = num_repeats + 1 WHERE key = ?");
      repeat.bind(1, r.key);
      repeat.exec();
      return;
    }
    if (before) {
      SQLite::Statement drop(db, "DELETE FROM runs WHERE key = ?");
      drop.bind(1, r.key);
      drop.exec();
    }
    write(r);
  }
};

RunStore::RunStore(const std::filesystem::path& file, Mode mode) {
  if (mode != Mode::make && !std::filesystem::exists(file))
    throw ConfigError({fmt::format("{}: there is no such evaluation store", file.string())});
  const int flags = mode == Mode::read_only ? SQLite::OPEN_READONLY
                    : mode == Mode::make    ? SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE
                                            : SQLite::OPEN_READWRITE;
  try {
    impl_ = std::make_unique<Impl>(file, flags);
    impl_->db.exec("PRAGMA foreign_keys = ON");
    const int version = impl_->db.execAndGet("PRAGMA user_version").getInt();
    const bool fresh = impl_->db.execAndGet("SELECT count(*) FROM sqlite_master").getInt() == 0;
    if ((!fresh || mode != Mode::make) && version != format_version)
      throw ConfigError({fmt::format("{}: is an SQLite file, but no evaluation store of format {} "
                                     "(its user_version is {})",
                                     file.string(), format_version, version)});
    if (mode == Mode::read_only) return;
    SQLite::Transaction transaction(impl_->db, SQLite::TransactionBehavior::IMMEDIATE);
    impl_->db.exec(schema);
    impl_->db.exec(fmt::format("PRAGMA user_version = {}", format_version));
    transaction.commit();
  } catch (const SQLite::Exception& e) {
    throw ConfigError({fmt::format("{}: cannot be used as evaluation store ({})", file.string(),
                                   e.what())});
  }
}

RunStore::~RunStore() = default;
RunStore::RunStore(RunStore&&) noexcept = default;

std::optional<RunRecord> RunStore::find(const std::string& key) const {
  try {
    SQLite::Statement run(impl_->db,
                          "SELECT solver, test, condition, seed, setup, material, state, reason, "
                          "num_tries, dt_s, num_steps, inertial_number, wall_s, host "
                          "FROM runs WHERE key = ?");
    run.bind(1, key);
    if (!run.executeStep()) return std::nullopt;
    RunRecord r;
    r.key = key;
    r.identity = {run.getColumn(0), run.getColumn(1), run.getColumn(2),
                  static_cast<std::uint64_t>(run.getColumn(3).getInt64()), run.getColumn(4),
                  run.getColumn(5)};
    r.state = state_from(run.getColumn(6));
    r.reason = run.getColumn(7).getString();
    r.num_tries = run.getColumn(8);
    r.dt_s = run.getColumn(9);
    r.num_steps = run.getColumn(10);
    r.inertial_number = run.getColumn(11);
    r.wall_s = run.getColumn(12);
    r.host = run.getColumn(13).getString();
    SQLite::Statement feature(impl_->db,
                              "SELECT name, value FROM features WHERE key = ? ORDER BY position");
    feature.bind(1, key);
    while (feature.executeStep())
      r.features.push_back({feature.getColumn(0), feature.getColumn(1).isNull()
                                                      ? std::numeric_limits<double>::quiet_NaN()
                                                      : feature.getColumn(1).getDouble()});
    SQLite::Statement curve(impl_->db,
                            "SELECT name, columns, rows FROM curves WHERE key = ? ORDER BY position");
    curve.bind(1, key);
    while (curve.executeStep()) {
      NamedTable table{curve.getColumn(0), split(curve.getColumn(1)), {}};
      table.rows = unpacked(curve.getColumn(2).getString(), table.columns.size());
      r.curves.push_back(std::move(table));
    }
    return r;
  } catch (const SQLite::Exception& e) {
    impl_->fail(e);
  }
}

bool RunStore::lacks(const std::string& key) const {
  try {
    return impl_->stored_state(key).value_or(RunState::failed) == RunState::failed;
  } catch (const SQLite::Exception& e) {
    impl_->fail(e);
  }
}

void RunStore::add(std::span<const RunRecord> records) {
  try {
    SQLite::Transaction transaction(impl_->db, SQLite::TransactionBehavior::IMMEDIATE);
    for (const RunRecord& r : records) impl_->add_one(r);
    transaction.commit();
  } catch (const SQLite::Exception& e) {
    impl_->fail(e);
  }
}

std::vector<RunStore::Count> RunStore::counts() const {
  SQLite::Statement query(impl_->db,
                          "SELECT solver, test, sum(state = 'COMPLETED'), sum(state = 'FAILED'), "
                          "sum(state = 'ABANDONED'), sum(wall_s) FROM runs "
                          "GROUP BY solver, test ORDER BY solver, test");
  std::vector<Count> counts;
  const auto number = [&](int column) {
    return static_cast<std::size_t>(query.getColumn(column).getInt64());
  };
  while (query.executeStep())
    counts.push_back({query.getColumn(0), query.getColumn(1), number(2), number(3), number(4),
                      query.getColumn(5).getDouble()});
  return counts;
}

std::vector<std::string> RunStore::keys(const std::string& prefix) const {
  SQLite::Statement query(impl_->db,
                          "SELECT key FROM runs WHERE substr(key, 1, ?) = ? ORDER BY rowid");
  query.bind(1, static_cast<std::int64_t>(prefix.size()));
  query.bind(2, prefix);
  std::vector<std::string> keys;
  while (query.executeStep()) keys.push_back(query.getColumn(0).getString());
  return keys;
}

std::size_t RunStore::num_repeats() const {
  return static_cast<std::size_t>(
      impl_->db.execAndGet("SELECT coalesce(sum(num_repeats), 0) FROM runs").getInt64());
}

std::size_t RunStore::remove(const Selection& s) {
  try {
    SQLite::Statement drop(impl_->db,
                           "DELETE FROM runs WHERE (?1 = '' OR solver <> ?1) AND (?2 = '' OR test = "
                           "?2) AND substr(key, 1, length(?3)) = ?3 AND (?4 = 0 OR state <> "
                           "'COMPLETED')");
    drop.bind(1, s.solver_not);
    drop.bind(2, s.test);
    drop.bind(3, s.key_prefix);
    drop.bind(4, s.only_failed ? 1 : 0);
    return static_cast<std::size_t>(drop.exec());
  } catch (const SQLite::Exception& e) {
    impl_->fail(e);
  }
}

std::size_t RunStore::merge(const RunStore& other) {
  std::vector<RunRecord> taken;
  for (const std::string& key : other.keys()) {
    if (!lacks(key)) continue;
    if (auto record = other.find(key)) taken.push_back(std::move(*record));
  }
  add(taken);
  return taken.size();
}

}  // namespace tilth
