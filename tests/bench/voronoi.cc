// SPDX-License-Identifier: GPL-3.0-or-later
/* voronoi N [ROUNDS]: writes the Voronoi cells of N random points in the unit cube, which
 * Lloyd's algorithm has moved to the centroids of their cells ROUNDS times (100), as a
 * stream of polyhedra; for the benchmarks. By voro++ (C. H. Rycroft, VORO++: A
 * three-dimensional Voronoi cell library in C++, Chaos 19, 2009), which makes each cell
 * for itself: corners of several cells within `same` are one node. */
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <random>
#include <vector>
#include <voro++/voro++.hh>

namespace
{
struct point {
    double x[3];
};

struct facet {
    int cell[2]; /* the second one -1 on the boundary */
    std::vector<int> node;
};

constexpr double same = 1e-9;

class nodes
{
  public:
    std::vector<point> all;

    /* The number of the node at p. */
    int at(const point &p)
    {
        long key[3];
        for (int k = 0; k < 3; k++)
            key[k] = std::lround(p.x[k] / width);
        for (long i = -1; i <= 1; i++)
            for (long j = -1; j <= 1; j++)
                for (long k = -1; k <= 1; k++) {
                    auto found = bin.find({key[0] + i, key[1] + j, key[2] + k});
                    if (found == bin.end())
                        continue;
                    for (int v : found->second)
                        if (is_near(all[v], p))
                            return v;
                }
        bin[{key[0], key[1], key[2]}].push_back((int)all.size());
        all.push_back(p);
        return (int)all.size() - 1;
    }

  private:
    static constexpr double width = 1e-6;
    std::map<std::vector<long>, std::vector<int>> bin;

    static bool is_near(const point &a, const point &b)
    {
        for (int k = 0; k < 3; k++)
            if (std::fabs(a.x[k] - b.x[k]) > same)
                return false;
        return true;
    }
};

/* Calls visit(cell number, its centre, the cell) for the Voronoi cell of each point. */
template <typename Visit>
void for_cells(const std::vector<point> &centre, const Visit &visit)
{
    const int blocks = std::max(1, (int)std::cbrt((double)centre.size() / 4)), first = 8;
    voro::container box(0, 1, 0, 1, 0, 1, blocks, blocks, blocks, false, false, false,
                        first);
    for (size_t c = 0; c < centre.size(); c++)
        box.put((int)c, centre[c].x[0], centre[c].x[1], centre[c].x[2]);
    voro::c_loop_all loop(box);
    voro::voronoicell_neighbor cell;
    if (loop.start())
        do
            if (box.compute_cell(cell, loop))
                visit(loop.pid(), centre[loop.pid()], cell);
        while (loop.inc());
}

void relax(std::vector<point> &centre)
{
    std::vector<point> moved = centre;
    for_cells(centre, [&](int c, const point &from, voro::voronoicell_neighbor &cell) {
        double by[3];
        cell.centroid(by[0], by[1], by[2]);
        for (int k = 0; k < 3; k++)
            moved[c].x[k] = from.x[k] + by[k];
    });
    centre = moved;
}

/* The facets of a cell that has a lesser number than the one beyond. */
void add_facets(int c, const point &from, voro::voronoicell_neighbor &cell, nodes &corner,
                std::vector<facet> &facets)
{
    std::vector<double> at;
    std::vector<int> beyond, loops, node;
    cell.vertices(from.x[0], from.x[1], from.x[2], at);
    cell.neighbors(beyond);
    cell.face_vertices(loops);
    for (size_t i = 0; i < at.size(); i += 3)
        node.push_back(corner.at({{at[i], at[i + 1], at[i + 2]}}));
    size_t next = 0;
    for (int other : beyond) {
        facet f{{c, other < 0 ? -1 : other}, {}};
        for (int i = 0; i < loops[next]; i++) {
            const int v = node[loops[next + 1 + i]];
            if (f.node.empty() || (v != f.node.back() && v != f.node.front()))
                f.node.push_back(v);
        }
        next += 1 + loops[next];
        std::reverse(f.node.begin(), f.node.end()); // to be seen from within
        if (f.node.size() >= 3 && (other < 0 || c < other))
            facets.push_back(f);
    }
}

void write(size_t cells, const nodes &corner, const std::vector<facet> &facets)
{
    std::vector<std::vector<size_t>> of(cells);
    std::printf("termesh 1\n.node\n%zu 3 0 0\n", corner.all.size());
    for (size_t v = 0; v < corner.all.size(); v++)
        std::printf("%zu %.17g %.17g %.17g\n", v, corner.all[v].x[0], corner.all[v].x[1],
                    corner.all[v].x[2]);
    std::printf(".facet\n%zu 0\n", facets.size());
    for (size_t f = 0; f < facets.size(); f++) {
        std::printf("%zu %d %d %zu", f, facets[f].cell[0], facets[f].cell[1],
                    facets[f].node.size());
        for (int v : facets[f].node)
            std::printf(" %d", v);
        std::printf("\n");
        for (int c : facets[f].cell)
            if (c >= 0)
                of[c].push_back(f);
    }
    std::printf(".cell\n%zu 0\n", cells);
    for (size_t c = 0; c < cells; c++) {
        std::printf("%zu %zu", c, of[c].size());
        for (size_t f : of[c])
            std::printf(" %zu", f);
        std::printf("\n");
    }
    std::printf(".end\n");
}
} // namespace

int main(int argc, char **argv)
{
    if (argc < 2) {
        std::fprintf(stderr, "usage: voronoi N [ROUNDS]\n");
        return 2;
    }
    const int usual = 100, rounds = argc > 2 ? std::atoi(argv[2]) : usual;
    std::vector<point> centre(std::strtoul(argv[1], nullptr, 10));
    std::mt19937_64 random(1);
    for (point &p : centre)
        for (double &x : p.x)
            x = (double)(random() >> 11) * 0x1p-53;
    for (int i = 0; i < rounds; i++)
        relax(centre);
    nodes corner;
    std::vector<facet> facets;
    for_cells(centre, [&](int c, const point &from, voro::voronoicell_neighbor &cell) {
        add_facets(c, from, cell, corner, facets);
    });
    write(centre.size(), corner, facets);
    return 0;
}
