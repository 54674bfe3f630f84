.error = this Makefile needs GNU make, often called gmake

# make           builds the experiments, ./bbm and the bench
# make run       runs the experiments: tables, pictures
# make paper     the paper alone: the experiments and the tests of the formulas without beyond/
# make gallery   runs the model files, each beside its theory: blocks that slide, topple, fall
# make check     runs every test (needs libcheck); make quick: the fast ones
# make bench     times solver and steps, as ratios
# make clean     removes what was made; what a student has written in out/exercise stays
#
# make exercise N=4.1  a copy without one function, and its tests; make hint N=4.1; make exercises lists them
# make page, check-page    the method in a browser (clang for wasm32), and its tests beside ./bbm
# make converge            refines the meshes of the experiments
# make memcheck, sanitize  the tests under valgrind; programs and tests under ASan and UBSan
# make torture             scenes that nobody has looked at, from SEED on (SCENES, TIME in seconds, KIND)
# make limit               statics beside a linear program of limit analysis (SEED, SCENES, TIME)
# make fuzz                arbitrary bytes for the readers of files, TIME in seconds, ten minutes (clang)
# make figures             draws doc/figures
# make size                counts the lines and writes them into the README
# make check-exercises, check-documents, check-recipes, check-arrows    parts of the tests
# make windows             ./bbm for Windows (mingw-w64)
#
# One goal is made with as many jobs as there are processors, unless -j says how many.

ifeq ($(MAKELEVEL)$(word 2,$(MAKECMDGOALS))$(filter -j%,$(MAKEFLAGS)),0)
MAKEFLAGS += -j$(shell getconf _NPROCESSORS_ONLN 2>/dev/null || echo 1)
endif

CC      ?= cc
CFLAGS  ?= -O2
STRICT   = -std=c99 -ffp-contract=off -Wall -Wextra -pedantic -Wshadow -Wconversion -Wstrict-prototypes \
           -Wmissing-prototypes
O        = out/build

# --- the files: the core, the library, the experiments, ./bbm ---
PAPER    = bbm contact solver
BASE     = build cut detect open_close order solve step
BEYOND   = beyond bending coarse crack energy equilibrium factor impact interpolation joints mesh multipliers overlap \
           refuse rotation sliding stability statics surroundings sweep
CORE     = $(PAPER) $(BASE:%=base/%)
LIBRARY  = $(CORE) $(BEYOND:%=beyond/%)
CASES    = exp1 exp2 exp3
COMMON   = cases/case cases/theory $(addprefix program/,cell field output plot scene)
SHARED   = $(COMMON) cases/beyond program/edge_load
READER   = $(addprefix program/,statements numbers build hooked stage msh reader model cell field)
PROGRAM  = $(READER) $(addprefix program/,main warn run write output plot scene edge_load)
HEADERS  = $(wildcard *.h base/*.h beyond/*.h cases/*.h program/*.h page/*.h tests/*.h)

all: $(CASES:%=$O/%) $O/bench bbm
	@echo "Try: ./bbm cases/models/arch.model, make run (the paper's experiments), make gallery, make check"

run: $(CASES:%=$O/%)
	@for c in $(CASES); do $O/$$c || exit 1; done
	@echo; echo "Open out/exp1/fig10.svg, out/exp2/fig15.svg and out/exp3/fig25.svg;" \
	"./bbm cases/models/exp3.model draws the film."

gallery: bbm
	@sh cases/gallery.sh

converge: $O/exp1 $O/exp2
	@for c in exp1 exp2; do $O/$$c converge || exit 1; done

# One thread, as ours: BLAS would wait for work on the others, and the clock counts that, too.
bench: $O/bench
	@OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1 $O/bench

$O/%.o: %.c $(HEADERS) Makefile
	@mkdir -p $(@D)
	$(CC) $(STRICT) $(CPPFLAGS) $(CFLAGS) -c -o $@ $<

$(CASES:%=$O/%): $O/%: $O/cases/%.o $(SHARED:%=$O/%.o) $(LIBRARY:%=$O/%.o)
	$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ -lm

$O/bbm: $(PROGRAM:%=$O/%.o) $(LIBRARY:%=$O/%.o)
	$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ -lm

bbm: $O/bbm
	cp $O/bbm bbm

# --- the paper alone: the core, the experiments with paper.c in place of what they have of beyond/ ---
paper: paper-run $O/paper/formulas
	$O/paper/formulas

paper-run: $(CASES:%=$O/paper/%)
	@for c in $(CASES); do $O/paper/$$c || exit 1; done

$(CASES:%=$O/paper/%): $O/paper/%: $O/cases/%.o $O/cases/paper.o $(COMMON:%=$O/%.o) $(CORE:%=$O/%.o)
	@mkdir -p $(@D)
	$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ -lm

# --- the same sources for Windows; isnan and isinf of mingw-w64 mention float whatever they are given ---
windows:
	@mkdir -p out/windows
	x86_64-w64-mingw32-gcc $(STRICT) -Wno-float-conversion $(CPPFLAGS) $(CFLAGS) -static -o out/windows/bbm.exe \
	$(PROGRAM:%=%.c) $(LIBRARY:%=%.c) -lm

clean:
	rm -rf $(filter-out out/exercise,$(wildcard out/*)) bbm

.PHONY: all run gallery converge bench paper paper-run windows clean
.DELETE_ON_ERROR:

include $(wildcard page/page.mk doc/doc.mk tests/*.mk)
