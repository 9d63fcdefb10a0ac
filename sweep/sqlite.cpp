// SPDX-License-Identifier: Apache-2.0
#include "sweep/merge.h"

#include <fmt/format.h>
#include <sqlite3.h>

#include <cmath>

namespace tessemu {

namespace {

class Database {
public:
    Database() { check(sqlite3_open(":memory:", &handle_)); }
    ~Database() { sqlite3_close(handle_); }
    Database(Database const&) = delete;

    void check(int status) const
    {
        if (status != SQLITE_OK && status != SQLITE_DONE && status != SQLITE_ROW)
            throw Error(std::string("SQLite: ") + sqlite3_errmsg(handle_));
    }
    void run(std::string const& sql)
    {
        check(sqlite3_exec(handle_, sql.c_str(), nullptr, nullptr, nullptr));
    }
    sqlite3* handle() const { return handle_; }
    std::string bytes() const
    {
        sqlite3_int64 size = 0;
        unsigned char* const data = sqlite3_serialize(handle_, "main", &size, 0);
        if (!data) throw std::bad_alloc();
        std::string out(reinterpret_cast<char const*>(data), std::size_t(size));
        sqlite3_free(data);
        return out;
    }

private:
    sqlite3* handle_ = nullptr;
};

class Insert {
public:
    Insert(Database& db, std::string const& table, std::size_t columns) : db_(db)
    {
        std::string marks;
        for (std::size_t i = 0; i < columns; ++i) marks += i ? ",?" : "?";
        db.check(sqlite3_prepare_v2(db.handle(),
                                    fmt::format("INSERT INTO {} VALUES ({})", table, marks).c_str(),
                                    -1, &statement_, nullptr));
    }
    ~Insert() { sqlite3_finalize(statement_); }
    Insert(Insert const&) = delete;

    void bind(int i, SweepTable::Cell const& cell)
    {
        db_.check(std::visit(
            [&](auto const& v) {
                using V = std::decay_t<decltype(v)>;
                if constexpr (std::is_same_v<V, std::monostate>)
                    return sqlite3_bind_null(statement_, i);
                else if constexpr (std::is_same_v<V, std::int64_t>)
                    return sqlite3_bind_int64(statement_, i, v);
                else if constexpr (std::is_same_v<V, double>)
                    return sqlite3_bind_double(statement_, i, v);
                else
                    return sqlite3_bind_text(statement_, i, v.data(), int(v.size()),
                                             SQLITE_TRANSIENT);
            },
            cell));
    }
    void add()
    {
        db_.check(sqlite3_step(statement_));
        db_.check(sqlite3_reset(statement_));
    }

private:
    Database& db_;
    sqlite3_stmt* statement_ = nullptr;
};

// What a column's cells are; those of an option are each as it is.
std::string type_of(SweepTable const& t, std::size_t column)
{
    SweepTable::Column const& c = t.columns[column];
    if (c.unit == "text") return "TEXT";
    if (c.unit == "option") return "";
    for (auto const& row : t.rows)
        if (double const* const x = std::get_if<double>(&row[column]); x && *x != std::floor(*x))
            return "REAL";
    return "INTEGER";
}

} // namespace

std::string sqlite_of(SweepTable const& t)
{
    // Columns of one table; rows of cases are wide.
    int const most = sqlite3_limit(Database().handle(), SQLITE_LIMIT_COLUMN, -1);
    if (t.columns.size() > std::size_t(most))
        throw LimitError("columns of a SQLite table", t.columns.size(), std::uint64_t(most));
    Database db;
    std::string columns;
    for (std::size_t i = 0; i < t.columns.size(); ++i)
        columns += fmt::format("{}\"{}\" {}", i ? "," : "", t.columns[i].name, type_of(t, i));
    db.run("BEGIN");
    db.run("CREATE TABLE cases (" + columns + ")");
    db.run("CREATE TABLE columns (name TEXT, unit TEXT, meaning TEXT)");
    {
        Insert row(db, "cases", t.columns.size());
        for (auto const& cells : t.rows) {
            for (std::size_t i = 0; i < cells.size(); ++i) row.bind(int(i) + 1, cells[i]);
            row.add();
        }
        Insert column(db, "columns", 3);
        for (SweepTable::Column const& c : t.columns) {
            int i = 0;
            for (std::string const& text : {c.name, c.unit, c.meaning}) column.bind(++i, text);
            column.add();
        }
    }
    db.run("COMMIT");
    return db.bytes();
}

} // namespace tessemu
