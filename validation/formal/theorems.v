(* The four theorems on which a verdict stands, over any ordered field: docs/exactness.md says them in words.
   Accepted by Debian's coq 8.16 with libcoq-mathcomp-algebra 1.15: `coqc -w none theorems.v`. *)
From mathcomp Require Import all_ssreflect all_algebra.
From Coq Require Import Ring.
Set Implicit Arguments. Unset Strict Implicit. Unset Printing Implicit Defensive.
Import GRing.Theory Num.Theory Order.Theory.
Local Open Scope ring_scope.

Section Field.
Variable F : realFieldType.

(* Coq's `ring`, which does not read the operations of mathcomp. *)
Definition zero : F := 0. Definition one : F := 1. Definition opp : F -> F := -%R.
Definition add : F -> F -> F := +%R. Definition mul : F -> F -> F := *%R. Definition sub (a b : F) : F := a - b.
Lemma field_is_a_ring : @ring_theory (Num.RealField.sort F) zero one add mul sub opp eq.
Proof. by split=> *; rewrite /add /mul ?(add0r, mul1r, mulrA, addrA, mulrDl, subrr) // 1?addrC // mulrC. Qed.
Add Ring field_ring : field_is_a_ring.
Ltac read t := lazymatch t with
  | ?a + ?b => let a := read a in let b := read b in constr:(add a b)
  | ?a * ?b => let a := read a in let b := read b in constr:(mul a b)
  | - ?a => let a := read a in constr:(opp a)
  | ?a *+ 2 => let a := read a in constr:(add a a)
  | 0 => constr:(zero) | 1 => constr:(one) | _ => constr:(t : Num.RealField.sort F) end.
Ltac algebra := lazymatch goal with |- ?l = ?r =>
  let l := read l in let r := read r in change (@eq (Num.RealField.sort F) l r); ring end.

(* ---- The step: minimise f where A x >= b; H is symmetric and positive definite. ---- *)
Section Step.
Variables n m : nat.
Implicit Types (H : 'M[F]_n) (A : 'M[F]_(m, n)) (g x y z e : 'cV[F]_n) (b lam v : 'cV[F]_m).
Definition dot k (u w : 'cV[F]_k) : F := (u^T *m w) 0 0.
Definition nonnegative k (u : 'cV[F]_k) := forall i, 0 <= u i 0.
Definition positive_definite H := H^T = H /\ forall x, x != 0 -> 0 < dot x (H *m x).
Definition square H x := dot x (H *m x).
Definition f H g x := square H x / 2%:R - dot g x.
Definition feasible A b x := nonnegative (A *m x - b).
(* Eqs. (9)-(12). *)
Definition kkt H g A b x lam :=
  [/\ H *m x - g = A^T *m lam, feasible A b x, nonnegative lam & dot lam (A *m x - b) = 0].
(* What optional/gap.py returns, with H z = g + A'lam: ||Hx - g - A'lam|| in the norm of H^-1 is ||x - z||_H. *)
Definition gap H A b x lam z := square H (x - z) / 2%:R + dot lam (A *m x - b).
Lemma dotD k (u v w : 'cV[F]_k) : dot u (v + w) = dot u v + dot u w. Proof. by rewrite /dot mulmxDr mxE. Qed.
Lemma dotN k (u w : 'cV[F]_k) : dot u (- w) = - dot u w. Proof. by rewrite /dot mulmxN mxE. Qed.
Lemma dotB k (u v w : 'cV[F]_k) : dot u (v - w) = dot u v - dot u w. Proof. by rewrite dotD dotN. Qed.
Lemma dotC k (u w : 'cV[F]_k) : dot u w = dot w u.
Proof. by rewrite /dot -[u^T *m w]trmxK [in LHS]mxE trmx_mul trmxK. Qed.
Lemma dotM A x lam : dot x (A^T *m lam) = dot lam (A *m x).
Proof. by rewrite dotC /dot trmx_mul trmxK mulmxA. Qed.
Lemma dot_ge0 k (u w : 'cV[F]_k) : nonnegative u -> nonnegative w -> 0 <= dot u w.
Proof. by move=> hu hw; rewrite /dot mxE sumr_ge0 // => i _; rewrite mxE mulr_ge0. Qed.
Lemma dotHC H x y : H^T = H -> dot x (H *m y) = dot y (H *m x).
Proof. by move=> sym; rewrite dotC /dot trmx_mul sym mulmxA. Qed.
Lemma square_ge0 H x : positive_definite H -> 0 <= square H x.
Proof. case=> _ pos; have [->|/pos/ltW //] := eqVneq x 0; by rewrite /square /dot mulmx0 mulmx0 mxE. Qed.
Lemma squareB H x y : H^T = H -> square H (x - y) = square H x - dot y (H *m x) *+ 2 + square H y.
Proof. move=> sym; rewrite /square mulmxBr !dotD !dotN ![dot (x - y) _]dotC !dotD !dotN.
rewrite ![dot (H *m _) _]dotC (dotHC x y sym); algebra.
Qed.
Lemma moved A b x y : A *m (x - y) = (A *m x - b) - (A *m y - b).
Proof. by rewrite mulmxBr opprB addrA subrK. Qed.
Lemma half (a : F) : a / 2%:R + a / 2%:R = a.
Proof. by rewrite -mulr2n -(mulr_natr (a / _)) mulfVK // pnatr_eq0. Qed.
Lemma taylor H g A x z lam : H^T = H -> H *m z - g = A^T *m lam ->
  f H g x - f H g z = square H (x - z) / 2%:R + dot lam (A *m (x - z)).
Proof. move=> sym stat; have -> : dot lam (A *m (x - z)) = dot z (H *m x) - square H z - dot g x + dot g z.
  rewrite -dotM -stat dotC !dotB !(dotC (_ - g)) !dotB (dotHC z x sym) !(dotC g) /square; algebra.
rewrite squareB // !mulrDl mulNr -(mulr_natr (dot _ _)) mulfK ?pnatr_eq0 // /f.
have := half (square H z); move: (square H z / _) => s <-; algebra.
Qed.

(* Theorem 1: of all feasible points, x alone minimises f. *)
Theorem only_minimiser H g A b x lam : positive_definite H -> kkt H g A b x lam ->
  forall y, feasible A b y -> y != x -> f H g x < f H g y.
Proof. move=> [sym pos] [stat _ lam0 comp] y fy yx; rewrite -subr_gt0 (taylor y sym stat).
by rewrite (moved A b) dotB comp subr0 ltr_paddr ?dot_ge0 // divr_gt0 ?ltr0n // pos // subr_eq0.
Qed.

(* Theorem 2: a Farkas vector refutes. *)
Theorem farkas A b lam : nonnegative lam -> A^T *m lam = 0 -> 0 < dot b lam -> forall x, ~ feasible A b x.
Proof. move=> lam0 balanced gain x fx; have := dot_ge0 lam0 fx.
by rewrite dotB -dotM balanced {1}/dot mulmx0 mxE add0r oppr_ge0 leNgt dotC gain.
Qed.
(* The gap is f(x) - d(lam): without constraints z minimises the Lagrangian, by theorem 1. *)
Lemma gap_of_objectives H g A b x lam z : H^T = H -> H *m z = g + A^T *m lam ->
  gap H A b x lam z = f H g x - (f H g z - dot lam (A *m z - b)).
Proof. move=> sym hz; have stat : H *m z - g = A^T *m lam by rewrite hz addrC addKr.
rewrite opprB addrC -addrA [- _ + _]addrC (taylor x sym stat) addrC -addrA -dotD.
by rewrite mulmxBr addrA subrK.
Qed.

(* Theorem 3: the error of any x, from its gap to any lam >= 0 and a v >= 0 that covers what x violates. *)
Section Error.
Variables (H : 'M[F]_n) (g xs z : 'cV[F]_n) (A : 'M[F]_(m, n)) (b lams lam : 'cV[F]_m).
Hypotheses (pd : positive_definite H) (opt : kkt H g A b xs lams).
Hypotheses (lam0 : nonnegative lam) (hz : H *m z = g + A^T *m lam).
Theorem error_bound x v : nonnegative (A *m x - b + v) ->
  square H (x - xs) <= 2%:R * (gap H A b x lam z + dot lams v).
Proof. move=> cover; have [[sym _] [stat fs lams0 comp]] := (pd, opt).
have open : 0 <= gap H A b xs lam z by rewrite addr_ge0 ?dot_ge0 // divr_ge0 ?square_ge0 ?ler0n.
have parts : gap H A b x lam z - square H (x - xs) / 2%:R = gap H A b xs lam z + dot lams (A *m x - b).
  rewrite !(gap_of_objectives _ _ sym hz); have := taylor x sym stat; rewrite (moved A b) dotB comp subr0 => ft.
  by rewrite -[f H g x](subrK (f H g xs)) ft; algebra.
rewrite -ler_pdivr_mull ?ltr0n // mulrC -subr_ge0 addrAC parts -addrA -dotD.
exact: addr_ge0 open (dot_ge0 lams0 cover).
Qed.
Corollary error_bound_feasible x : feasible A b x -> square H (x - xs) <= 2%:R * gap H A b x lam z.
Proof. by move=> fx; have := @error_bound x 0; rewrite addr0 /dot mulmx0 mxE addr0; apply. Qed.
End Error.
End Step.

(* ---- Rounding to the nearest number of a grid, ties to an even one. ---- *)
Section Rounding.
Variables grid even : F -> Prop.
Implicit Types x y r s lo hi : F.
Definition rounds x r :=
  grid r /\ forall y, grid y -> y != r -> `|x - r| < `|x - y| \/ `|x - r| = `|x - y| /\ even r.
Definition neighbours lo hi := [/\ grid lo, grid hi, lo < hi & forall y, grid y -> y <= lo \/ hi <= y].
(* x against the half of lo + hi. *)
Definition by_halves lo hi x r :=
  if x + x < lo + hi then r = lo else if lo + hi < x + x then r = hi else (r = lo \/ r = hi) /\ even r.
Lemma squares a b x : `|x - b| ^+ 2 - `|x - a| ^+ 2 = (b - a) * (a + b - (x + x)).
Proof. rewrite !real_normK ?num_real // !expr2; algebra. Qed.
Lemma nearer a b x : a < b -> (`|x - a| < `|x - b|) = (x + x < a + b).
Proof. by move=> ab; rewrite -ltr_sqr ?nnegrE // -subr_gt0 squares pmulr_rgt0 subr_gt0. Qed.
Lemma farther a b x : a < b -> (`|x - b| < `|x - a|) = (a + b < x + x).
Proof. by move=> ab; rewrite -ltr_sqr ?nnegrE // -subr_lt0 squares pmulr_rlt0 ?subr_gt0 ?subr_lt0. Qed.
Lemma equally a b x : a < b -> (`|x - a| == `|x - b|) = (x + x == a + b).
Proof. move=> ab; rewrite -(eqr_expn2 (n := 2)) // eq_sym -[LHS]subr_eq0 squares mulf_eq0 !subr_eq0.
by rewrite gt_eqF // eq_sym.
Qed.
(* The same, without distances. *)
Lemma roundsP x r : rounds x r <->
  [/\ grid r, forall y, grid y -> y < r -> y + r < x + x \/ y + r = x + x /\ even r &
   forall y, grid y -> r < y -> x + x < r + y \/ x + x = r + y /\ even r].
Proof. split=> [[gr near]|[gr below above]]; split=> // y gy ne.
- case: (near y gy) => [||[/eqP]]; rewrite ?(lt_eqF ne) ?(farther _ ne) //; first by left.
  by rewrite eq_sym (equally _ ne) => /eqP; right.
- case: (near y gy) => [||[/eqP]]; rewrite ?(gt_eqF ne) ?(nearer _ ne) ?(equally _ ne) //; first by left.
  by move/eqP; right.
have [yr|ry|e] := ltgtP y r; last by rewrite e eqxx in ne.
- rewrite (farther _ yr); case: (below y gy yr) => [|[e ev]]; [by left | right; split=> //].
  by apply/eqP; rewrite eq_sym (equally _ yr) e.
- rewrite (nearer _ ry); case: (above y gy ry) => [|[e ev]]; [by left | right; split=> //].
  by apply/eqP; rewrite (equally _ ry) e.
Qed.

(* Theorem 4: the comparison of x with the half of its neighbours lo and hi. *)
Theorem halves_round lo hi x r : neighbours lo hi -> lo <= x <= hi -> by_halves lo hi x r -> rounds x r.
Proof. move=> [glo ghi lh gaps] /andP[lx xh].
have below : x + x <= lo + hi -> (x + x = lo + hi -> even lo) -> rounds x lo.
  move=> le tie; apply/roundsP; split=> // y gy yl.
    by left; apply: lt_le_trans (ler_add lx lx); rewrite ltr_add2r.
  have hy : lo + hi <= lo + y by rewrite ler_add2l; case: (gaps y gy) => // /(lt_le_trans yl); rewrite ltxx.
  have := le_trans le hy; rewrite le_eqVlt => /orP[/eqP e|]; [right|by left].
  by split=> //; apply: tie; apply/eqP; rewrite eq_le le e hy.
have above : lo + hi <= x + x -> (x + x = lo + hi -> even hi) -> rounds x hi.
  move=> le tie; apply/roundsP; split=> // y gy yh.
    have yl : y + hi <= lo + hi by rewrite ler_add2r; case: (gaps y gy) => // /le_lt_trans/(_ yh); rewrite ltxx.
    have := le_trans yl le; rewrite le_eqVlt => /orP[/eqP e|]; [right|by left].
    by split=> //; apply: tie; apply/eqP; rewrite eq_le le -e yl.
  by left; apply: le_lt_trans (ler_add xh xh) _; rewrite ltr_add2l.
rewrite /by_halves; case: (ltgtP (x + x) (lo + hi)) => [lt ->|gt ->|e [[->|->] ev]].
- by apply: below (ltW lt) _ => e; rewrite e ltxx in lt.
- by apply: above (ltW gt) _ => e; rewrite e ltxx in gt.
- by apply: below => //; rewrite e.
- by apply: above => //; rewrite e.
Qed.
(* `nearest_in`, first: c lies between the halves towards both of its neighbours. *)
Theorem between_halves_rounds below c above x : neighbours below c -> neighbours c above ->
  below + c < x + x < c + above -> rounds x c.
Proof. move=> nb na /andP[lb ub]; have [xc|/ltW cx] := leP x c.
  apply: (halves_round nb); last by rewrite /by_halves lb ltNge (ltW lb).
  by rewrite xc andbT leNgt; apply/negP => /ltW xb; have := ler_add xb xc; rewrite leNgt lb.
apply: (halves_round na); last by rewrite /by_halves ub.
by rewrite cx /= leNgt; apply/negP => /ltW ax; have := ler_add cx ax; rewrite leNgt ub.
Qed.
(* `nearest_in`, second: both ends of a ball have the same answer. *)
Theorem ends_round low high x c : rounds low c -> rounds high c -> low <= x <= high -> rounds x c.
Proof. move=> /roundsP[gc down _] /roundsP[_ _ up] /andP[lx xh]; apply/roundsP; split=> // y gy yc.
  have := ler_add lx lx; case: (down y gy yc) => [h /(lt_le_trans h)|[<- ev]]; first by left.
  by rewrite le_eqVlt => /orP[/eqP|]; [right|left].
have := ler_add xh xh; case: (up y gy yc) => [h /le_lt_trans/(_ h)|[-> ev]]; first by left.
by rewrite le_eqVlt => /orP[/eqP|]; [right|left].
Qed.
End Rounding.

(* ---- Binary numbers of q + 1 bits, with exponents from emin to emax; subnormal numbers at emin. ---- *)
Section Binary.
Variables (q : nat) (emin emax : int).
Hypotheses (q_gt0 : (0 < q)%N) (exponents : emin <= emax).
Implicit Types (x y lo hi r : F) (k e : int).
Definition value k e : F := k%:~R * 2%:R ^ e.
(* The form in which a number is written, normal or subnormal: k is its significand. *)
Definition canonical k e := [/\ `|k| < 2 ^+ q.+1, emin <= e <= emax & (2 ^+ q <= `|k|) || (e == emin)].
Definition number y := exists k e, canonical k e /\ y = value k e.
Definition even_number y := exists k e, [/\ canonical k e, y = value k e & (2 %| k)%Z].
Lemma pow_gt0 e : 0 < 2%:R ^ e :> F. Proof. by rewrite exprz_gt0 ?ltr0n. Qed.
Lemma value_lt k l e : (value k e < value l e) = (k < l).
Proof. by rewrite /value ltr_pmul2r ?pow_gt0 // ltr_int. Qed.
Lemma value_shift k e (d : nat) : value k (e + d%:Z) = value (k * 2 ^+ d) e.
Proof. by rewrite /value expfzDr ?pnatr_eq0 // -exprnP rmorphM rmorphX /= -mulrA [_ ^+ d * _]mulrC. Qed.
Lemma shift_of e e' : e <= e' -> exists d : nat, e' = e + d%:Z.
Proof. by move=> le; exists `|e' - e|%N; rewrite gez0_abs ?subr_ge0 // addrC subrK. Qed.
Lemma canonical_once k e l e' : canonical k e -> canonical l e' -> value k e = value l e' -> k = l.
Proof. wlog le : k e l e' / e <= e' => [sym ck cl v|].
  by case: (leP e e') => [|/ltW] le; [apply: (sym k e l e')|apply/esym/(sym l e' k e)].
have [d ->] := shift_of le; rewrite value_shift => -[kb /andP[ee _] _] [lb _ form] v.
have {v} kl : k = l * 2 ^+ d by case: (ltgtP k (l * 2 ^+ d)) => //; rewrite -(value_lt _ _ e) v ltxx.
case: d => [|d] in form kl *; first by rewrite kl mulr1.
have big : 2 ^+ q <= `|l| by case/orP: form => // /eqP ed; move: ee; rewrite -ed ger_addl.
suff : 2 ^+ q.+1 <= `|k| by rewrite leNgt kb.
by rewrite kl normrM exprS mulrC ler_pmul ?exprn_ge0 // ger0_norm ?exprn_ge0 // exprS ler_pemulr ?exprn_ege1.
Qed.
Lemma even_numberP k e : canonical k e -> even_number (value k e) <-> (2 %| k)%Z.
Proof. by move=> ck; split=> [[l [e' [cl /(canonical_once ck cl) ->]]]|ev] //; exists k, e. Qed.
(* What follows a number that is not negative. *)
Lemma successor k e y : canonical k e -> 0 <= k -> number y -> value k e < y -> value (k + 1) e <= y /\
  (canonical (k + 1) e \/ k + 1 = 2 ^+ q.+1 /\ canonical (2 ^+ q) (e + 1)).
Proof. move=> [kb /andP[ee eb] form] k0 [l [e' [[lb /andP[ee' eb'] _] ->]]] lt.
rewrite ger0_norm // in kb form.
have [up|down] := leP e e'; last first.
  have [[|d] ed] := shift_of (ltW down); first by rewrite ed addr0 ltxx in down.
  have big : 2 ^+ q <= k by case/orP: form => // /eqP em; rewrite em ltNge ee' in down.
  move: lt; rewrite ed value_shift value_lt ltNge => /negP[].
  apply: le_trans (ler_norm l) _; apply: le_trans (ltW lb) _.
  by rewrite !exprS mulrC ler_pmul ?exprn_ge0 // ler_pemulr ?exprn_ege1.
have [d ed] := shift_of up; rewrite ed value_shift value_lt in lt *; split.
  by rewrite leNgt value_lt -leNgt lez_addr1.
have [small|] := ltP (k + 1) (2 ^+ q.+1).
  left; split; rewrite ?ee // ger0_norm ?addr_ge0 //; case/orP: form => [h|->]; last by rewrite orbT.
  by rewrite (le_trans h) // ler_addl.
rewrite le_eqVlt ltNge lez_addr1 kb orbF => /eqP/esym last; right; split=> //; split.
- by rewrite ger0_norm ?exprn_ge0 // ltr_eexpn2l.
- rewrite (le_trans ee) ?ler_addl //= lez_addr1 lt_neqAle eb andbT; apply/eqP => em.
  have d0 : d = 0%N by case: (d) ed => // c ed; move: eb'; rewrite ed em ger_addl.
  by have := le_lt_trans (ler_norm l) lb; rewrite -last ltz_addr1 leNgt; move: lt; rewrite d0 mulr1 => ->.
- by rewrite ger0_norm ?exprn_ge0 // lexx.
Qed.
Lemma zero_is_a_number : number 0.
Proof. by exists 0, emin; rewrite /canonical normr0 exprn_gt0 // lexx exponents eqxx orbT /value mul0r. Qed.
Lemma numberN y : number y -> number (- y).
Proof. by case=> k [e [[? ? ?] ->]]; exists (- k), e; rewrite /canonical normrN /value mulrNz mulNr. Qed.
Lemma even_numberN y : even_number y -> even_number (- y).
Proof.
by case=> k [e [[? ? ?] -> ?]]; exists (- k), e; rewrite /canonical normrN /value mulrNz mulNr dvdzE abszN -dvdzE.
Qed.
(* Of two neighbours exactly one is even, so that the rule gives one number. *)
Lemma one_is_even lo hi : neighbours number lo hi ->
  (even_number lo \/ even_number hi) /\ ~ (even_number lo /\ even_number hi).
Proof. wlog lo0 : lo hi / 0 <= lo => [nonneg nb|[nlo nhi lh gaps]].
  have [|neg] := leP 0 lo; first by move/nonneg; apply.
  have [glo ghi lh gaps] := nb.
  have hi0 : hi <= 0 by case: (gaps 0 zero_is_a_number) => //; rewrite leNgt neg.
  have [|| some both] := nonneg (- hi) (- lo); first by rewrite oppr_ge0.
    split; rewrite ?ltr_opp2; try exact: numberN; first by [].
    by move=> y /numberN/gaps; rewrite ler_oppl [hi <= _]ler_oppr => -[]; [right|left].
  split=> [|[el eh]]; last by case: both; split; apply: even_numberN.
  by case: some => /even_numberN; rewrite opprK; [right|left].
case: nlo => k [e [ck vlo]]; rewrite {}vlo in lo0 lh gaps *.
have k0 : 0 <= k by rewrite -(ler_int F) -(pmulr_lge0 _ (pow_gt0 e)).
have [next forms] := successor ck k0 nhi lh.
have parity : (2 %| k + 1)%Z = ~~ (2 %| k)%Z.
  by case: k k0 {ck lo0 lh gaps next forms} => // c _; rewrite !dvdzE !absz_nat !dvdn2 addn1 /= negbK.
have even_power d : (2 %| (2 : int)%R ^+ d.+1)%Z by rewrite exprS dvdz_mulr.
have [l [e' [cl vl el]]] : exists l e',
  [/\ canonical l e', value (k + 1) e = value l e' & (2 %| l)%Z = ~~ (2 %| k)%Z].
  case: forms => [c|[last c]]; first by exists (k + 1), e.
  exists (2 ^+ q), (e + 1); rewrite -parity last even_power -(prednK q_gt0) even_power (prednK q_gt0).
  by rewrite (value_shift _ _ 1) exprSr.
have -> : hi = value l e'.
  apply/eqP; rewrite eq_le -{2}vl next andbT; have [] // := gaps (value l e'); first by exists l, e'.
  by rewrite -vl leNgt value_lt ltr_addl.
by rewrite !even_numberP // el; split; [case: (2 %| k)%Z; [left|right] | case=> ->].
Qed.
End Binary.

(* Theorem 4 of binary64: for the neighbours of x the rule of halves gives the nearest number, ties to even. *)
Definition binary64 := number 52 (- 1074%:Z) 971.
Definition even64 := even_number 52 (- 1074%:Z) 971.
Theorem binary64_rounds lo hi x : neighbours binary64 lo hi -> lo <= x <= hi ->
  exists! r, by_halves even64 lo hi x r /\ rounds binary64 even64 x r.
Proof. move=> nb between; have [one both] := one_is_even (isT : (0 < 52)%N) (isT : - 1074%:Z <= 971) nb.
suff [r [rule once]] : exists! r, by_halves even64 lo hi x r.
  by exists r; split=> [|s [/once]] //; split=> //; apply: halves_round nb between rule.
rewrite /by_halves; case: ltgtP => _; [by exists lo; split | by exists hi; split |].
case: one => ev; [exists lo | exists hi]; split=> [|r [[->|->] er]] //; try by case: both.
  by split; [left|].
by split; [right|].
Qed.
End Field.

Print Assumptions only_minimiser.
Print Assumptions farkas.
Print Assumptions error_bound.
Print Assumptions error_bound_feasible.
Print Assumptions halves_round.
Print Assumptions binary64_rounds.
Print Assumptions between_halves_rounds.
Print Assumptions ends_round.
