// Nacre: the red-black solver: bins three apart at once, a team per bin, its particles one after the other (sec. 3.2,
// 3.3).
#pragma once

#include "compute/particles/levenberg_marquardt.hpp"
#include "compute/particles/neighbourhoods.hpp"
#include "compute/particles/solver_state.hpp"

namespace nacre {

namespace detail {

/// Moves the moving particles of one bin, one after the other, and writes them back: for the later ones of this bin
/// into the neighbourhood's copy, for the other bins into the set.
template <class Surface>
struct RelaxBin {
  Surface surface;
  SolverParameters parameters;
  const Junction* table;
  float largest;
  Float4 *position, *direction;
  float* damping;

  std::size_t scratch_bytes() const { return NearInNeighbourhood::bytes + projection_scratch<Surface>(); }

  NACRE_HD void operator()(Team& team, const Neighbourhood& around) const {
    for (int k = 0; k < around.own; ++k)
      if ((around.rows.tag[k] & Relation::fixed) == 0) relax(team, around, k);
  }

 private:
  NACRE_HD void relax(Team& team, const Neighbourhood& around, int k) const {
    const NeighbourhoodMemory& r = around.rows;
    const Mover start{{r.x[k], r.y[k], r.z[k]}, r.h[k], {r.nx[k], r.ny[k], r.nz[k]}};
    const std::uint32_t interface = r.tag[k], i = r.particle[k];
    const NearInNeighbourhood near(team, team.scratch(), around, {table, interface}, k, start, parameters.step);
    const RelaxedParticle done =
        relax_particle(team, near, team.scratch() + NearInNeighbourhood::bytes, surface, parameters, interface,
                       table[interface].order(), largest, start, damping[i]);
    team.wait();  // all lanes have read the old position
    if (team.first()) {
      const Mover& at = done.at;
      r.x[k] = at.p.x, r.y[k] = at.p.y, r.z[k] = at.p.z, r.h[k] = at.h;
      r.nx[k] = at.direction.x, r.ny[k] = at.direction.y, r.nz[k] = at.direction.z;
      position[i] = {at.p.x, at.p.y, at.p.z, at.h};
      direction[i] = {at.direction.x, at.direction.y, at.direction.z, done.energy};
      damping[i] = done.damping;
    }
    team.wait();
  }
};

}  // namespace detail

/// One turn for every moving particle, in 27 colours; leaves each one's energy in direction.w. `table`: the junctions
/// that particles' interface numbers stand for. The same result on any number of threads. Step at most h/2 unless the
/// parameters say otherwise; see bin_edge.
template <class Backend, class Surface>
IterationResult redblack_iteration(Executor<Backend>& exec, ParticleSet& set, SolverState& state,
                                   const Array<Junction>& table, const Surface& surface,
                                   const SolverParameters& parameters) {
  if (set.count <= set.fixed) return {};
  Arena::Scope scope(exec.arena());
  exec.for_each(set.count - set.fixed, detail::ReadSize<Surface>{surface, set.position.data() + set.fixed});
  Neighbourhoods<Backend> neighbourhoods(exec, set, parameters.step);
  neighbourhoods.for_each(detail::RelaxBin<Surface>{surface, parameters, table.data(), neighbourhoods.bins().largest,
                                                    set.position.data(), set.direction.data(), state.damping.data()});
  return {mean_energy(exec, set), 0, 0};
}

}  // namespace nacre
