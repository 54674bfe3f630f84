#!/bin/sh
# gallery.sh - every model file beside its theory, then some of them beyond their limits, where they do
# not do what is expected (status 3):   make gallery
set -eu
LIMITS="arch:t=1 topple:phi=19 slope:phi=38.114 slope:wet=0.5:phi=38.98 tilt:gx=4.76864 spread:half=0.601
    dominoes:spin=-1.45 shaken:phi=34 wall:A=8:courses=4:bricks=8 conveyor:phi=9.9 keyblock:part=0.99
    portal:part=1.01 retaining:part=1.01 water:part=1.01 bolted:part=0.99 brazil:part=1.05 wedge:T=4e6"
mkdir -p out/models
models=0 limits=0
for m in cases/models/*.model; do
    ./bbm "$m" -o "out/models/$(basename "$m" .model)"
    models=$((models + 1))
done
for limit in $LIMITS; do
    m=${limit%%:*} status=0
    printf '%s: beyond its limit ' "$limit"
    ./bbm -q "cases/models/$m.model" $(echo "${limit#"$m"}" | sed 's/:/ -d /g') -o "out/models/$m-beyond" \
        > out/models/beyond 2>&1 || status=$?
    [ $status = 3 ] || { cat out/models/beyond; echo "$limit: not as it should be"; exit 1; }
    echo "it does not do what is expected, as it should be"
    limits=$((limits + 1))
done
./bbm -q cases/models/arch.model -d steps=200 --find t 0.95 1.2
echo "the gallery is as it should be: $models models do what theory says, $limits do not beyond their limits;" \
    "theory has the arch's at t = 1.061"
echo "Look at out/models/arch-beyond/movie.svg in a browser."
