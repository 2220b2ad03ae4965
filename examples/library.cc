// SPDX-License-Identifier: GPL-3.0-or-later
// The library in C++: the same as library.c, with objects that free themselves.
//
//   c++ -o library library.cc $(pkg-config --cflags --libs termesh)
//   tetgen-mesh -q knot.off | ./library >better.tm
#include <termesh/termesh.h>

#include <cstdio>
#include <stdexcept>
#include <unistd.h>

namespace
{

struct failure : std::runtime_error {
    tm_status status;
    explicit failure(const tm_error &error)
        : std::runtime_error(error.what), status(error.status)
    {
    }
};

void check(tm_status status, const tm_error &error)
{
    if (status != TM_OK)
        throw failure(error);
}

class stream
{
  public:
    stream()
    {
        tm_stream_init(&s);
    }
    ~stream()
    {
        tm_stream_free(&s);
    }
    stream(const stream &) = delete;
    stream &operator=(const stream &) = delete;
    tm_stream *get()
    {
        return &s;
    }
    const tm_block &block(const char *name) const
    {
        const tm_block *found = tm_stream_find(&s, name);
        if (!found)
            throw std::runtime_error("there are no tetrahedra");
        return *found;
    }

  private:
    tm_stream s;
};

void print_quality(const char *when, const stream &mesh)
{
    const tm_block &node = mesh.block(".node"), &ele = mesh.block(".ele");
    const double limit = 30;
    tm_tet_statistics s;
    tm_error error;
    check(tm_tet_statistics_measure(&s, reinterpret_cast<const double(*)[3]>(node.real),
                                    node.count,
                                    reinterpret_cast<const uint32_t(*)[4]>(ele.integer),
                                    ele.count, limit, 1, &error),
          error);
    std::fprintf(stderr, "%s: %zu tetrahedra, %.2f%% bad, angles %.1f to %.1f degrees\n",
                 when, s.tets, tm_percent(s.bad, s.tets), s.min_dihedral, s.max_dihedral);
}

void improve(stream &mesh)
{
    tm_tet_mesh tets;
    tm_error error;
    tm_improve_report report;
    tm_improve_options options = {};
    options.angle = 30;
    options.ops = TM_IMPROVE_ALL_OPS;
    tm_status status = tm_tet_mesh_from_stream(&tets, mesh.get(), 1, &error);
    if (status == TM_OK)
        status = tm_improve(&tets, &options, &report, &error);
    if (status == TM_OK)
        status = tm_tet_mesh_to_stream(&tets, mesh.get(), &error);
    tm_tet_mesh_free(&tets);
    check(status, error);
}

} // namespace

int main()
{
    try {
        stream mesh;
        tm_error error;
        check(tm_stream_read(mesh.get(), STDIN_FILENO, "<stdin>", 1, &error), error);
        print_quality("before", mesh);
        improve(mesh);
        print_quality("after", mesh);
        check(tm_stream_write(mesh.get(), STDOUT_FILENO, 1, &error), error);
    } catch (const failure &e) {
        std::fprintf(stderr, "library: %s\n", e.what());
        return e.status;
    } catch (const std::exception &e) {
        std::fprintf(stderr, "library: %s\n", e.what());
        return TM_ERROR_INPUT;
    }
    return 0;
}
