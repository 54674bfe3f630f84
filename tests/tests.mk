# tests.mk - the tests. The suites are named in tests/suites.h alone.
suites   = $(shell sed -n 's/^$(1)(\(.*\))/check_\1/p' tests/suites.h)
QUICK   := $(call suites,FORMULAS) $(call suites,QUICK)
OUTSIDE := $(call suites,LIBRARY) $(call suites,PROGRAM)
TORTURE  = scenes ledger trial
SHARING  = models shapes systems programs
FAILING  = -Dmalloc=test_malloc -Dcalloc=test_calloc -Drealloc=test_realloc -Dfree=test_free
CHECK   := $(shell pkg-config --libs check 2>/dev/null || echo -lcheck -lsubunit -lrt -lpthread)

# --- the library once more, with an allocator that can be made to fail ---
# The same objects with other names, or where these cannot be changed compiled once more.
RENAME = $(if $(findstring -flto,$(CFLAGS)),false,objcopy $(patsubst -D%,--redefine-sym %,$(FAILING)))

$O/failing/%.o: $O/%.o
	@mkdir -p $(@D)
	@$(RENAME) $< $@ 2>/dev/null || $(CC) $(STRICT) $(FAILING) $(CPPFLAGS) $(CFLAGS) -c -o $@ $*.c

# The programs with that allocator take the number of allocations from the environment, TEST_ALLOCATIONS.
$O/failing/bbm: $(PROGRAM:%=$O/failing/%.o) $(LIBRARY:%=$O/failing/%.o) $O/tests/test_alloc.o
	$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ -lm

$(CASES:%=$O/failing/%): $O/failing/%: $O/failing/cases/%.o $(SHARED:%=$O/failing/%.o) \
$(LIBRARY:%=$O/failing/%.o) $O/tests/test_alloc.o
	$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ -lm

# --- the tests' programs: quick, check (all), paper/formulas (without beyond/) ---
# To compile the tests themselves, and what draws figures, takes longer than what an optimizer would spare.
HASTY = $(addprefix tests/,$(QUICK) models $(OUTSIDE)) doc/figures
TESTS = $(addprefix $O/tests/,$(addsuffix .o,$(QUICK) $(SHARING) $(OUTSIDE) $(TORTURE) check_run test_alloc))
MAINS = $(addprefix $O/tests/check_,main.o all.o paper.o)

$(HASTY:%=$O/%.o): override CFLAGS += -O0
$(TESTS): override CPPFLAGS += -DBUILD='"$O"'
$(TESTS) $(MAINS): | libcheck

$O/tests/check_all.o: DEFINE = -DCASES
$O/tests/check_paper.o: DEFINE = -DPAPER
$O/tests/check_all.o $O/tests/check_paper.o: tests/check_main.c $(HEADERS) Makefile
	@mkdir -p $(@D)
	$(CC) $(STRICT) $(DEFINE) $(CPPFLAGS) $(CFLAGS) -c -o $@ $<

TESTED = $(addprefix $O/tests/,$(addsuffix .o,$(QUICK) $(SHARING) rock test_alloc)) $O/cases/theory.o \
         $(LIBRARY:%=$O/failing/%.o)

$O/quick: $O/tests/check_main.o $(TESTED) | $O/bbm
	$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(CHECK) -lm

$O/check: $O/tests/check_all.o $(addprefix $O/tests/,$(addsuffix .o,$(OUTSIDE) $(TORTURE))) $(PAGE:%=$O/%.o) $(TESTED)
	$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(CHECK) -lm

$O/paper/formulas: $O/tests/check_paper.o $O/tests/check_formulas.o $O/tests/shapes.o $(CORE:%=$O/%.o)
	@mkdir -p $(@D)
	$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(CHECK) -lm

libcheck:
	@echo '#include <check.h>' | $(CC) $(CPPFLAGS) -E - >/dev/null 2>&1 || { echo \
	"The tests need libcheck: apt-get install check (Debian, Ubuntu), or libcheck.github.io/check"; exit 1; }

quick: $O/quick
	$O/quick

# --- make check: the tests in parts side by side, each to a file ---
PARTS    = programs experiments library
CONVERGE = exp1 exp2
CALLS    = $(CASES:%=run-%) $(CONVERGE:%=converge-%) again without-beyond
SAY      = $O/check $* > $O/$*.said 2>&1 || echo "ended with status $$?" >> $O/$*.said

check: $(PARTS:%=check-%) check-documents check-exercises check-arrows check-size
	@cat $(PARTS:%=$O/%.said)
	@awk -f tests/sum.awk $(PARTS:%=$O/%.said)

# The longest part begins as soon as all that it needs is compiled, and the others after it.
NEEDED = $O/check $(CASES:%=$O/%) $O/bbm $(CASES:%=$O/failing/%) $O/failing/bbm

check-library $(CALLS): | $(NEEDED)

check-programs: check-%: $(NEEDED)
	CK_EXCLUDE_TAGS=experiments $(SAY)

check-library: check-%: $O/check
	$(SAY)

check-experiments: check-%: $O/check experiments
	CK_RUN_SUITE=cases $(SAY)

# Everything that the experiments print; what hangs is ended after ten minutes of the processor.
LIMIT = mkdir -p out; ulimit -t 600;

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
# their objects are those made here, which are newer than the sources. The third experiment is linked,
# but takes too long to run twice.
ALONE_MADE = $(CORE) $(COMMON) $(CASES:%=cases/%) cases/paper $(addprefix tests/,shapes check_formulas check_paper)
ALONE_READ = $(patsubst %,%.c,$(subst check_paper,check_main,$(ALONE_MADE)))
ALONE_DIRS = $(sort $(dir $(ALONE_MADE:%=build/%)))
PLAIN      = $(if $(CPPFLAGS)$(filter-out -O2,$(CFLAGS)),,$(ALONE_MADE:%=$O/%.o))
TAKE       = $(CC) $(STRICT) -DPAPER -fsyntax-only $(ALONE_READ) && mkdir -p $(ALONE_DIRS) && \
             for o in $(ALONE_MADE:%=%.o); do cp -p ../../$O/$$o build/$$o || exit 1; done
MAKE_ALONE = env -u CK_RUN_SUITE -u CK_RUN_CASE $(MAKE) -s -C out/paper O=build CPPFLAGS= CFLAGS=-O2

without-beyond: $(PLAIN)
	@rm -rf out/paper && mkdir -p out/paper
	@cp -rp Makefile *.c *.h base cases program tests out/paper
	@$(if $(PLAIN),cd out/paper && $(TAKE))
	+@$(MAKE_ALONE) build/paper/exp3
	+@$(LIMIT) $(MAKE_ALONE) paper CASES='exp1 exp2' > out/paper/paper.log 2>&1

# Which file calls which: from the object files.
check-arrows: $(LIBRARY:%=$O/%.o)
	@nm -A $^ | awk -f tests/arrows.awk

# How large the project is, and may be.
SIZED = $(wildcard *.[ch] page/*.html page/*.css \
        $(foreach f,base beyond cases program page tests doc,$f/*.[ch] $f/*.js $f/*.awk $f/*.sh))

check-size:
	@awk -f tests/size.awk $(SIZED)

size:
	@awk -v README=README.md -f tests/size.awk $(SIZED) > out/README.md && cp out/README.md README.md

# --- memory: valgrind, ASan and UBSan; and check-smoke, a short part of these, in .ci/run ---
memcheck:
	$(MAKE) O=out/memcheck CPPFLAGS=-DGUARD=0 out/memcheck/quick
	CK_FORK=no valgrind -q --error-exitcode=1 --leak-check=full --errors-for-leak-kinds=definite,indirect,possible \
	out/memcheck/quick

SANITIZED = out/sanitize
SANITIZERS = -fsanitize=address,undefined -fno-sanitize-recover=all
SANITIZE = O=$(SANITIZED) CPPFLAGS=-DGUARD=0 CFLAGS="-g -O1 $(SANITIZERS)"
HAS_SANITIZERS = { mkdir -p out && echo 'int main(void) { return 0; }' > out/none.c && \
$(CC) $(SANITIZERS) -o out/none out/none.c 2>/dev/null || \
! echo "no sanitizers here: the programs were not run with them"; }

sanitize:
	$(MAKE) $(SANITIZE) all check

# Not optimized, since compiling takes most of it.
check-smoke:
	@[ $O = $(SANITIZED) ] || ! $(HAS_SANITIZERS) || \
	$(MAKE) -s $(SANITIZE) O=out/smoke CFLAGS="-g1 $(SANITIZERS)" smoke

# The shipped models with the matrix, of those that take longest here a few steps, which reach the same
# lines and branches; and all wrong ones, by one process, since its start takes longer than a model.
SLOW = exp3 wall resting tilt dominoes spread slope arch column conveyor cradle portal retaining shaken turning wedge
FEW  = /^expect/d; /^dynamic/s/ \(steps\|settle\) [^ ]*/ \1 3/g; s/^let \(steps\|courses\) .*/let \1 3/

$O/wrong: $O/tests/wrong.o $(patsubst %,$O/%.o,$(filter-out program/main,$(PROGRAM))) $(LIBRARY:%=$O/%.o)
	$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ -lm

smoke: $O/bbm $O/wrong
	@mkdir -p $O/run
	@for m in $(SLOW); do sed '$(FEW)' cases/models/$$m.model > $O/run/$$m.model; done
	@sed '/^expect/d; s/^let steps .*/let steps 12/' cases/models/wedge.model > $O/run/wedge.model
	@for m in $(filter-out $(SLOW:%=cases/models/%.model),$(wildcard cases/models/*.model)) \
	$(SLOW:%=$O/run/%.model); do \
	$O/bbm -q $$m -o $O/run/good -m $O/run/K.mtx || { echo "$$m failed"; exit 1; }; done
	@$O/wrong $O/run/bad tests/bad/*.model 2> $O/run/said || { tail -n 99 $O/run/said; exit 1; }

# --- the bench: beside CHOLMOD, a direct solver, where it is installed; nothing else needs it ---
CHOLMOD_HERE = $(shell mkdir -p out && echo 'int main(void) { return 0; }' > out/probe.c && \
$(CC) -include suitesparse/cholmod.h -o out/probe out/probe.c -lcholmod 2>/dev/null && echo -DCHOLMOD)

$O/tests/bench.o: override CPPFLAGS += $(CHOLMOD_HERE)

$O/bench: $O/tests/bench.o $O/tests/rock.o $(SHARED:%=$O/%.o) $(LIBRARY:%=$O/%.o)
	$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(CHOLMOD_HERE:-DCHOLMOD=-lcholmod) -lm

# --- random scenes, first by the library, then by ./bbm and its tables; KIND is a kind of the first ---
HOSTILE = $(or $(SEED),1) $(or $(SCENES),0) $(or $(TIME),60)

torture: $O/torture $O/hostile bbm
	@$O/torture $(HOSTILE) $(KIND); bad=$$?; $(if $(KIND),,$O/hostile $(HOSTILE) || bad=1;) exit $$bad

$O/torture: $O/tests/torture.o $(TORTURE:%=$O/tests/%.o) $(LIBRARY:%=$O/%.o)
	$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ -lm

# Statics of ./bbm beside a linear program of limit analysis.
limit: $O/limit bbm
	@$O/limit check && $O/limit $(HOSTILE)

$O/hostile $O/limit: $O/%: $O/tests/%.o
	$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ -lm

fuzz:
	@mkdir -p out/corpus
	clang -std=c99 -g -O1 -DMOST_CELLS=40000 -fsanitize=address,undefined,fuzzer -fno-sanitize-recover=all -o out/fuzz \
	tests/fuzz_model.c $(READER:%=%.c) $(LIBRARY:%=%.c) -lm
	out/fuzz -max_len=4096 -timeout=100 -max_total_time=$(or $(TIME),600) -seed=$(or $(SEED),0) -artifact_prefix=out/ \
	out/corpus tests/bad tests/mesh cases/models

.PHONY: quick check memcheck sanitize smoke fuzz torture limit libcheck size check-size check-smoke check-arrows experiments
.PHONY: $(PARTS:%=check-%) $(CALLS)
