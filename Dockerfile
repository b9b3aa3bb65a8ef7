# This file is part of the MPM package for LAMMPS, distributed under the GNU
# General Public License, version 2; see the file LICENSE.
#
# docker build -t lammps-mpm .
# docker run --rm -v "$PWD":/run -w /run --user "$(id -u)" lammps-mpm -in in.first
# For several processes: docker run ... --entrypoint mpirun lammps-mpm -np 4 lmp -in in.first

FROM debian:trixie-slim AS build
WORKDIR /mpm
COPY . .
RUN apt-get update && tools/package_deb.sh

FROM debian:trixie-slim
COPY --from=build /mpm/build/packages/ /packages/
RUN apt-get update \
 && apt-get install -y --no-install-recommends /packages/*.deb openmpi-bin python3-numpy python3-matplotlib \
 && rm -rf /packages /var/lib/apt/lists/*
ENV PYTHONPATH=/usr/lib/lammps-mpm/python \
    OMPI_MCA_rmaps_base_oversubscribe=1 \
    OMPI_MCA_btl_vader_single_copy_mechanism=none
ENTRYPOINT ["lmp"]
CMD ["-h"]
