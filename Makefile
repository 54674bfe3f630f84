# make           builds the experiments        make check     every test (needs libcheck)
# make run       runs them: tables, pictures   make quick     the fast ones, and ./bbm once
# make paper     the paper alone, without beyond/: runs the experiments its way, and the tests of the formulas
# make bench     solver, steps: ratios         make memcheck  the tests under valgrind
# make gallery   the model files, each beside its theory: blocks that slide, topple, fall
# make torture   scenes that nobody has looked at, from SEED on (SCENES, TIME in seconds, KIND)
# make fuzz      arbitrary bytes for the readers of files, ten minutes (clang)
# make converge  meshes against alpha          make sanitize  programs and tests under ASan and UBSan
# make page      out/bbm.html, the method in a browser (clang for wasm32); make check-page: beside ./bbm
# make windows   ./bbm for Windows (mingw-w64)
# make exercise N=4.1  a copy without one function, and its tests; make hint N=4.1; make exercises lists them
# make figures   draws doc/figures             make check-exercises   each red as it begins, green in the end
# make check-recipes   doc/recipes.md with the tools that are installed: Gmsh, Octave, gnuplot, SciPy, PETSc
# One goal is made with as many jobs as there are processors, unless -j says how many.

ifeq ($(MAKELEVEL)$(word 2,$(MAKECMDGOALS))$(filter -j%,$(MAKEFLAGS)),0)
MAKEFLAGS += -j$(shell getconf _NPROCESSORS_ONLN 2>/dev/null || echo 1)
endif

CC      ?= cc
CFLAGS  ?= -O2
STRICT   = -std=c99 -ffp-contract=off -Wall -Wextra -pedantic -Wshadow -Wconversion -Wstrict-prototypes -Wmissing-prototypes
PAPER    = bbm contact solver
BASE     = build cut detect open_close order solve step
CORE     = $(PAPER) $(BASE:%=base/%)
LIBRARY  = $(CORE) $(BEYOND:%=beyond/%)
BEYOND   = beyond bending coarse energy factor impact interpolation joints mesh multipliers overlap refuse rotation sliding statics \
           surroundings sweep
RUN      = exp1 exp2 exp3
CASES    = $(RUN)
# Beyond their limits models do not do what is expected of them (status 3).
BEYOND_LIMITS = arch:t=1 topple:phi=19 slope:phi=38.114 slope:wet=0.5:phi=38.98 tilt:gx=4.76864 spread:half=0.601 \
                dominoes:spin=-1.45 shaken:phi=34 wall:A=8:courses=4:bricks=8 conveyor:phi=9.9 keyblock:part=0.99 portal:part=1.01 \
                retaining:part=1.01 water:part=1.01 bolted:part=0.99
COMMON   = cases/case cases/theory $(addprefix program/,cell field output plot scene)
SHARED   = $(COMMON) cases/beyond program/edge_load
READER   = $(addprefix program/,statements numbers build hooked stage msh reader model cell field)
PROGRAM  = $(READER) $(addprefix program/,main warn run find write output plot scene edge_load)
TORTURE  = scenes ledger trial
PAGE     = page/page $(READER) $(addprefix program/,run warn edge_load)
PROGRAMS = check_cases check_model check_statements check_moving check_files check_pictures \
           check_scenes check_page $(TORTURE)
SUITES   = check_formulas check_elastic check_steps check_mesh check_input check_detection check_corners \
           check_entrance check_open_close check_sliding check_joints check_blocks check_repeat check_solver \
           check_coarse check_beyond check_motion check_bars check_statics check_refused \
           check_theory check_run check_impact
SHARING  = models shapes systems programs
HEADERS  = $(wildcard *.h base/*.h beyond/*.h cases/*.h program/*.h page/*.h tests/*.h)
O        = out/build
FAILING  = -Dmalloc=test_malloc -Dcalloc=test_calloc -Drealloc=test_realloc -Dfree=test_free
CHECK   := $(shell pkg-config --libs check 2>/dev/null || echo -lcheck -lsubunit -lrt -lpthread)

all: $(CASES:%=$O/%) $O/bench bbm
	@echo "Try: ./bbm cases/models/arch.model, make run (the paper's experiments), make gallery, make check"

run: $(RUN:%=$O/%)
	@for c in $(RUN); do $O/$$c || exit 1; done
	@echo; echo "Open out/exp1/fig10.svg, out/exp2/fig15.svg and out/exp3/fig25.svg; ./bbm cases/models/exp3.model draws the film."

gallery: bbm
	@mkdir -p out/models
	@for m in cases/models/*.model; do ./bbm $$m -o out/models/$$(basename $$m .model) || exit 1; done
	@for f in $(BEYOND_LIMITS); do m=$${f%%:*}; printf '%s: beyond its limit ' $$f; \
	./bbm -q cases/models/$$m.model $$(echo $${f#$$m} | sed 's/:/ -d /g') -o out/models/$$m-beyond > out/models/beyond 2>&1; \
	[ $$? = 3 ] || { cat out/models/beyond; echo "$$f: not as it should be"; exit 1; }; \
	echo "it does not do what is expected, as it should be"; done
	@./bbm -q cases/models/arch.model -d steps=400 --find t 0.95 1.2
	@echo "the gallery is as it should be: $(words $(wildcard cases/models/*.model)) models do what theory says," \
	"$(words $(BEYOND_LIMITS)) do not beyond their limits; theory has the arch's at t = 1.061"
	@echo "Look at out/models/arch-beyond/movie.svg in a browser."

converge: $O/exp1 $O/exp2
	@for c in exp1 exp2; do $O/$$c converge || exit 1; done

bench: $O/bench
	@$O/bench

$(CASES:%=$O/%): $O/%: $O/cases/%.o $(SHARED:%=$O/%.o) $(LIBRARY:%=$O/%.o)
	$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ -lm

# What Experiment I shows beyond the paper.
$O/exp1: $O/cases/exp1_beyond.o
$O/failing/exp1: $O/failing/cases/exp1_beyond.o

# --- the paper alone: the core, the experiments with paper.c in place of what they have of beyond/ ---
paper: paper-run $O/paper/formulas
	$O/paper/formulas

paper-run: $(RUN:%=$O/paper/%)
	@for c in $(RUN); do $O/paper/$$c || exit 1; done

$(RUN:%=$O/paper/%): $O/paper/%: $O/cases/%.o $O/cases/paper.o $(COMMON:%=$O/%.o) $(CORE:%=$O/%.o)
	@mkdir -p $(@D)
	$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ -lm

$O/paper/formulas: $O/tests/check_paper.o $O/tests/check_formulas.o $O/tests/shapes.o $(CORE:%=$O/%.o)
	@mkdir -p $(@D)
	$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(CHECK) -lm

bbm: $O/bbm
	cp $O/bbm bbm

# The figures of the documents, by doc/figures.c; a test compares them.
figures: $O/figures
	$O/figures doc/figures

$O/figures: $O/doc/figures.o $O/program/plot.o $O/program/output.o $(CORE:%=$O/%.o)
	$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ -lm

$O/bbm: $(PROGRAM:%=$O/%.o) $(LIBRARY:%=$O/%.o)
	$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ -lm

# The direct solver that bench compares with, where it is installed; nothing else needs it.
CHOLMOD_HERE = $(shell mkdir -p out && echo 'int main(void) { return 0; }' > out/probe.c && \
$(CC) -include suitesparse/cholmod.h -o out/probe out/probe.c -lcholmod 2>/dev/null && echo -DCHOLMOD)

$O/tests/bench.o: override CPPFLAGS += $(CHOLMOD_HERE)

$O/bench: $O/tests/bench.o $O/tests/rock.o $(SHARED:%=$O/%.o) $(LIBRARY:%=$O/%.o)
	$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(CHOLMOD_HERE:-DCHOLMOD=-lcholmod) -lm

$O/torture: $O/tests/torture.o $(TORTURE:%=$O/tests/%.o) $(LIBRARY:%=$O/%.o)
	$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ -lm

# First by the library, then by ./bbm and its tables; KIND is a kind of the first.
HOSTILE = $(or $(SEED),1) $(or $(SCENES),0) $(or $(TIME),60)

torture: $O/torture $O/hostile bbm
	@$O/torture $(HOSTILE) $(KIND); bad=$$?; $(if $(KIND),,$O/hostile $(HOSTILE) || bad=1;) exit $$bad

$O/hostile: $O/tests/hostile.o
	$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ -lm

$O/%.o: %.c $(HEADERS) Makefile
	@mkdir -p $(@D)
	$(CC) $(STRICT) $(CPPFLAGS) $(CFLAGS) -c -o $@ $<

# --- the page: the same sources as WebAssembly, in one HTML file that needs nothing else ---
PAGE_CC    = clang --target=wasm32-wasi -mexec-model=reactor -flto -D_WASI_EMULATED_PROCESS_CLOCKS
PAGE_CALLS = malloc free $(addprefix page_,load free state step text numbers data)
EMPTY      =
COMMA      = ,

page: out/bbm.html

out/bbm.wasm: $(PAGE:%=%.c) $(LIBRARY:%=%.c) $(HEADERS) Makefile
	@mkdir -p $(@D)
	$(PAGE_CC) $(STRICT) -O2 -o $@ $(PAGE:%=%.c) $(LIBRARY:%=%.c) -Wl,$(subst $(EMPTY) $(EMPTY),$(COMMA),$(PAGE_CALLS:%=--export=%)) \
	-Wl,--strip-all,--stack-first,-z,stack-size=1048576 -lm -lwasi-emulated-process-clocks

PAGE_FILES = $(addprefix page/,page.html style.css assemble.awk wasi.js model.js picture.js graphs.js inspect.js page.js)
PAGE_DATA  = out/bbm.wasm $(wildcard cases/models/*.model cases/models/*.msh) doc/by-hand.model out/exercises.txt out/states.txt

# The exercises of the kind predict, as they stand in the chapters.
out/exercises.txt: $(wildcard doc/0*.md) Makefile
	@mkdir -p $(@D)
	awk '/^#/ { title = $$0; on = 0 } /^\| predict/ { print title; on = 1 } on' $(filter %.md,$^) > $@

# The table of states.
out/states.txt: doc/06-contact.md Makefile
	@mkdir -p $(@D)
	grep -E '^\| (OPEN|LOCK|SLIDE) ' $< > $@

out/bbm.html: $(PAGE_FILES) $(PAGE_DATA) Makefile
	awk -f page/assemble.awk page/page.html $(PAGE_DATA) > $@

# --- tests: the library once more, with an allocator that can be made to fail ---
# The same objects with other names, or where these cannot be changed compiled once more.
RENAME = $(if $(findstring -flto,$(CFLAGS)),false,objcopy $(patsubst -D%,--redefine-sym %,$(FAILING)))

$O/failing/%.o: $O/%.o
	@mkdir -p $(@D)
	@$(RENAME) $< $@ 2>/dev/null || $(CC) $(STRICT) $(FAILING) $(CPPFLAGS) $(CFLAGS) -c -o $@ $*.c

# The programs with that allocator take the number of allocations from the environment, TEST_ALLOCATIONS.
$O/failing/bbm: $(PROGRAM:%=$O/failing/%.o) $(LIBRARY:%=$O/failing/%.o) \
$O/tests/test_alloc.o
	$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ -lm

$(CASES:%=$O/failing/%): $O/failing/%: $O/failing/cases/%.o $(SHARED:%=$O/failing/%.o) \
$(LIBRARY:%=$O/failing/%.o) $O/tests/test_alloc.o
	$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ -lm

$(PROGRAMS:%=$O/tests/%.o) $O/tests/check_run.o $O/tests/programs.o: override CPPFLAGS += -DBUILD='"$O"'

# To compile the tests themselves, and what draws figures, takes longer than what an optimizer would spare.
HASTY = $(addprefix tests/,$(SUITES) models $(filter-out $(TORTURE),$(PROGRAMS))) doc/figures

$(HASTY:%=$O/%.o): override CFLAGS += -O0

$O/tests/check_all.o: DEFINE = -DCASES
$O/tests/check_paper.o: DEFINE = -DPAPER
$O/tests/check_all.o $O/tests/check_paper.o: tests/check_main.c $(HEADERS) Makefile
	@mkdir -p $(@D)
	$(CC) $(STRICT) $(DEFINE) $(CPPFLAGS) $(CFLAGS) -c -o $@ $<

TESTED = $(SUITES:%=$O/tests/%.o) $(SHARING:%=$O/tests/%.o) $O/tests/rock.o $O/tests/test_alloc.o $O/cases/theory.o $(LIBRARY:%=$O/failing/%.o)

$O/quick: $O/tests/check_main.o $(TESTED) | $O/bbm
	$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(CHECK) -lm

$O/check: $O/tests/check_all.o $(PROGRAMS:%=$O/tests/%.o) $(PAGE:%=$O/%.o) $(TESTED)
	$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(CHECK) -lm

$(SUITES:%=$O/tests/%.o) $(SHARING:%=$O/tests/%.o) $(PROGRAMS:%=$O/tests/%.o) $O/tests/test_alloc.o: | libcheck
$O/tests/check_main.o $O/tests/check_all.o $O/tests/check_paper.o: | libcheck

libcheck:
	@echo '#include <check.h>' | $(CC) $(CPPFLAGS) -E - >/dev/null 2>&1 || \
	{ echo "The tests need libcheck: apt-get install check (Debian, Ubuntu), or libcheck.github.io/check"; exit 1; }

quick: $O/quick
	$O/quick

# --- the exercises in the chapters of doc/: a copy of a source in out/exercise/N, and its tests ---
ALONE = $(CORE:%=$O/%.o)
EXERCISE = O="$O" COMPILE="$(CC) $(STRICT) -Wno-unused -Wno-unused-parameter $(CPPFLAGS) $(CFLAGS) -O0" FAILING="$(FAILING)" \
LINK="$(CC) $(CFLAGS) $(LDFLAGS)" LIBS="$(CHECK) -lm" TESTED="$O/tests/check_main.o $(TESTED)" ALONE="$(ALONE)" COMMON="$(COMMON:%=$O/%.o)" \
MAKE="$(MAKE) -s" sh tests/exercise.sh

exercise:
	+@$(EXERCISE) begin $(or $(N),0)

hint:
	@sh tests/exercise.sh hint $(or $(N),0) $(or $(STEP),1)

exercises:
	@sh tests/exercise.sh list

check-exercises: check-library $O/quick $O/doc/exercises/own.o $(ALONE) $O/paper/exp2
	+@$(EXERCISE) prove

# The page in node and in Chromium, and natively with musl, whose libm is that of WASI.
check-page: out/bbm.html $O/bbm $O/musl/page_native
	@rm -rf out/page && mkdir -p out/page
	node tests/check_page.js $O/bbm $O/musl/page_native out/page

$O/musl/page_native: tests/page_native.c $(PAGE:%=%.c) $(LIBRARY:%=%.c) $(HEADERS) Makefile
	@mkdir -p $(@D)
	musl-gcc $(STRICT) -O2 -o $@ $(filter %.c,$^) -lm

# The figures of the documents, the names in them, the table of the equations, the commands and what
# these print.
HOUSE = grep -ohE '[a-z0-9]+(_[a-z0-9]+)+' doc/house.svg

check-documents: $O/figures $O/bbm experiments
	@rm -rf $O/drawn && mkdir $O/drawn && $O/figures $O/drawn && diff -r $O/drawn doc/figures || \
	{ echo "doc/figures is not what the program draws: make figures"; exit 1; }
	@for f in $$(sed -n 's/.*monospace[^>]*>\([a-z_]*\)<.*/\1/p' doc/figures/flow.svg); do \
	grep -q "[ *]$$f(" base/step.c || { echo "doc/figures/flow.svg names $$f, which base/step.c does not have"; exit 1; }; done
	@[ $$($(HOUSE) | wc -l) -gt 30 ] && for w in $$($(HOUSE)); do \
	grep -qw $$w bbm.h bbm.c contact.c solver.c base/base.h base/build.c beyond/beyond.c || { echo "doc/house.svg names $$w"; exit 1; }; done
	@for f in $$(grep -owE '[a-z0-9_]+[.]c' doc/house.svg); do [ -f $$f ] || [ -f base/$$f ] || [ -f beyond/$$f ] || \
	{ echo "doc/house.svg names $$f"; exit 1; }; done
	@for f in beyond/*.c; do grep -qw $${f#*/} doc/house.svg || { echo "doc/house.svg lacks $$f"; exit 1; }; done
	@awk -f tests/equations.awk doc/equations.md *.c */*.c
	@sed -n '/no error/!s/.*\[BBM_[A-Z_]*\] = "\([^"]*\)".*/\1/p' base/cut.c | while read -r text; do \
	grep -qF -- "- **$$text**" doc/failures.md || { echo "doc/failures.md has no \"$$text\""; exit 1; }; done
	@awk -v O=$O -f tests/documents.awk README.md doc/*.md

# The recipes with other tools, as far as they are installed; mpirun refuses to work for root unasked.
check-recipes: $O/bbm
	@rm -rf out/recipes && mkdir -p out && cp -r doc/recipes out
	@OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 \
	awk -v PROGRAMS='$(abspath $O)' -f tests/recipes.awk doc/recipes.md

# How large the project is, and may be.
CODE = $(wildcard *.[ch] page/*.html page/*.css $(foreach f,base beyond cases program page tests doc,$f/*.[ch] $f/*.js $f/*.awk $f/*.sh))
BUDGET = awk -f tests/budget.awk README.md $(CODE)

check-budget:
	@$(BUDGET)

# The tests in parts side by side, each to a file: those that run programs, those of the library, and
# those of what the experiments print.
PARTS    = programs experiments library
CONVERGE = exp1 exp2
CALLS    = $(CASES:%=run-%) $(CONVERGE:%=converge-%) again without-beyond
SAY      = $O/check $* > $O/$*.said 2>&1 || echo "ended with status $$?" >> $O/$*.said

check: $(PARTS:%=check-%) check-documents check-smoke check-exercises check-arrows
	@cat $(PARTS:%=$O/%.said)
	@awk -F '[:,]' '/^[0-9]+%: Checks:/ { run += $$3; failed += $$5 + $$7 } /^ended with status/ { bad = 1 } \
	END { print run " checks, " failed " failed" (bad ? ": not passed" : ""); exit bad }' $(PARTS:%=$O/%.said)
	@$(BUDGET)

# The longest part begins as soon as all that it needs is compiled, and the others after it.
NEEDED = $O/check $(CASES:%=$O/%) $O/bbm $(CASES:%=$O/failing/%) $O/failing/bbm

check-library check-smoke $(CALLS): | $(NEEDED)

check-programs: check-%: $(NEEDED)
	CK_EXCLUDE_TAGS=experiments $(SAY)

check-library: check-%: $O/check
	$(SAY)

check-experiments: check-%: $O/check experiments
	CK_RUN_SUITE=cases $(SAY)

# Everything that the experiments print; what hangs is ended after ten minutes of the processor.
LIMIT    = mkdir -p out; ulimit -t 600;

experiments: $(CALLS)

$(CASES:%=run-%): run-%: $O/%
	@$(LIMIT) $O/$* > out/$*.log

$(CONVERGE:%=converge-%): converge-%: $O/%
	@$(LIMIT) $O/$* converge > out/converge-$*.log

# Once more, where neither a picture nor what it prints can be written.
again: $O/exp2
	@rm -rf out/again && mkdir -p out/again/cases out/again/out/exp2/fig15.svg/x && cp cases/fem.csv out/again/cases
	@$(LIMIT) cd out/again && { ../../$O/exp2 > /dev/full 2> said; echo "status $$?" >> said; }

# `make paper` in the tree without beyond/, where all its sources compile. With the same flags
# their objects are those made here, which are newer than the sources.
ALONE_MADE = $(CORE) $(COMMON) $(RUN:%=cases/%) cases/paper \
             $(addprefix tests/,shapes check_formulas check_paper)
ALONE_READ = $(patsubst %,%.c,$(subst check_paper,check_main,$(ALONE_MADE)))
ALONE_DIRS = $(sort $(dir $(ALONE_MADE:%=build/%)))
PLAIN      = $(if $(CPPFLAGS)$(filter-out -O2,$(CFLAGS)),,$(ALONE_MADE:%=$O/%.o))
TAKE       = $(CC) $(STRICT) -DPAPER -fsyntax-only $(ALONE_READ) && mkdir -p $(ALONE_DIRS) && \
             for o in $(ALONE_MADE:%=%.o); do cp -p ../../$O/$$o build/$$o || exit 1; done

without-beyond: $(PLAIN)
	@rm -rf out/paper && mkdir -p out/paper
	@cp -rp Makefile *.c *.h base cases program tests out/paper
	@$(if $(PLAIN),cd out/paper && $(TAKE))
	@$(LIMIT) env -u CK_RUN_SUITE -u CK_RUN_CASE $(MAKE) -s -C out/paper paper O=build CPPFLAGS= \
	CFLAGS=-O2 > out/paper/paper.log 2>&1

# Which file calls which: from the object files.
check-arrows: $(LIBRARY:%=$O/%.o)
	@nm -A $^ | awk -f tests/arrows.awk

# Not optimized, since compiling takes most of it.
check-smoke:
	@[ $O = $(SANITIZED) ] || ! $(HAS_SANITIZERS) || $(MAKE) -s $(SANITIZE) O=out/smoke CFLAGS="-g1 $(SANITIZERS)" smoke

memcheck:
	$(MAKE) O=out/memcheck CPPFLAGS=-DGUARD=0 out/memcheck/quick
	CK_FORK=no valgrind -q --error-exitcode=1 --leak-check=full --errors-for-leak-kinds=definite,indirect,possible \
	out/memcheck/quick

# --- ASan and UBSan: all programs and tests; and the short part of it that `make check` does, too ---
SANITIZED = out/sanitize
SANITIZERS = -fsanitize=address,undefined -fno-sanitize-recover=all
SANITIZE = O=$(SANITIZED) CPPFLAGS=-DGUARD=0 CFLAGS="-g -O1 $(SANITIZERS)"
HAS_SANITIZERS = { mkdir -p out && echo 'int main(void) { return 0; }' > out/none.c && \
$(CC) $(SANITIZERS) -o out/none out/none.c 2>/dev/null || ! echo "no sanitizers here: the programs were not run with them"; }

sanitize:
	$(MAKE) $(SANITIZE) all check

# The shipped models with the matrix, of those that take longest here a few steps, which reach the same
# lines and branches; and all wrong ones, by one process, since its start takes longer than a model.
SLOW = exp3 wall resting tilt dominoes spread slope arch column conveyor cradle portal retaining shaken turning
FEW  = /^expect/d; /^dynamic/s/ \(steps\|settle\) [0-9][0-9]*/ \1 3/g; s/^let \(steps\|courses\) .*/let \1 3/

$O/wrong: $O/tests/wrong.o $(patsubst %,$O/%.o,$(filter-out program/main,$(PROGRAM))) $(LIBRARY:%=$O/%.o)
	$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ -lm

smoke: $O/bbm $O/wrong
	@mkdir -p $O/run
	@for m in $(SLOW); do sed '$(FEW)' cases/models/$$m.model > $O/run/$$m.model; done
	@for m in $(filter-out $(SLOW:%=cases/models/%.model),$(wildcard cases/models/*.model)) $(SLOW:%=$O/run/%.model); do \
	$O/bbm -q $$m -o $O/run/good -m $O/run/K.mtx || { echo "$$m failed"; exit 1; }; done
	@$O/wrong $O/run/bad tests/bad/*.model 2> $O/run/said || { tail -n 99 $O/run/said; exit 1; }

# The same sources for Windows; isnan and isinf of mingw-w64 mention float whatever they are given.
WINDOWS = x86_64-w64-mingw32-gcc

windows:
	@mkdir -p out/windows
	$(WINDOWS) $(STRICT) -Wno-float-conversion $(CPPFLAGS) $(CFLAGS) -static -o out/windows/bbm.exe $(PROGRAM:%=%.c) \
	$(LIBRARY:%=%.c) -lm

fuzz:
	@mkdir -p out/corpus
	clang -std=c99 -g -O1 -fsanitize=address,undefined,fuzzer -fno-sanitize-recover=all -o out/fuzz tests/fuzz_model.c \
	$(READER:%=%.c) $(LIBRARY:%=%.c) -lm
	out/fuzz -max_len=4096 -timeout=100 -max_total_time=600 -artifact_prefix=out/ out/corpus tests/bad tests/mesh cases/models

# What a student has written in out/exercise stays.
clean:
	rm -rf $(filter-out out/exercise,$(wildcard out/*)) bbm

.PHONY: all run paper paper-run gallery converge bench quick memcheck sanitize smoke windows fuzz torture libcheck clean
.PHONY: page check-page check-recipes
.PHONY: check $(PARTS:%=check-%) check-smoke check-arrows check-exercises check-documents check-budget experiments exercise exercises hint figures $(CALLS)
.DELETE_ON_ERROR:
