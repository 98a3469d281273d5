#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes roc.csv and logistic.csv beside itself: areas under curves and logistic regressions.

Made with scipy 1.10.1 and statsmodels 0.13.5 (python3-scipy, python3-statsmodels of Debian 12);
needed only to make the files anew. Rows of roc.csv, values parted by spaces:
    auc (scipy's Mann-Whitney U), DeLong's variance by its definition, natural, kidnapped
Rows of logistic.csv, where a fit has the intercept first:
    fit, coefficients, standard errors, log likelihood, selected features
    stepwise, coefficients, standard errors, log likelihood, selected features
    ridge, coefficients, penalty
    example, label, features                                      of the fits before it
"""

from pathlib import Path

import numpy as np
import statsmodels.api as sm
from scipy import optimize, stats

random = np.random.default_rng(1580)
ENTER_P, LEAVE_P = 0.05, 0.10


def numbers(values):
    return " ".join(repr(float(value)) for value in np.atleast_1d(values))


def delong_variance(natural, kidnapped):
    """DeLong, DeLong, Clarke-Pearson (1988), eqs. 3-5, pair by pair."""
    wins = np.array([[(k > n) + 0.5 * (k == n) for n in natural] for k in kidnapped], float)
    return (np.var(wins.mean(axis=1), ddof=1) / len(kidnapped)
            + np.var(wins.mean(axis=0), ddof=1) / len(natural))


def roc_rows():
    for n, k, shift, digits in ((5, 4, 0.5, 1), (40, 30, 1.0, 3), (40, 30, 1.0, 0),
                                (200, 17, 0.2, 3), (12, 60, 2.5, 2), (30, 30, -1.0, 3)):
        natural = np.round(random.normal(0, 1, n), digits)
        kidnapped = np.round(random.normal(shift, 1.3, k), digits)
        u = stats.mannwhitneyu(kidnapped, natural).statistic
        yield ",".join(map(numbers, (u / (n * k), delong_variance(natural, kidnapped),
                                     natural, kidnapped)))


def fitted(x, y, selected):
    model = sm.Logit(y, sm.add_constant(x[:, selected], has_constant="add"))
    return model.fit(disp=0, tol=1e-14, maxiter=200, method="newton")


def p_value(smaller, larger):
    return stats.chi2.sf(2 * (larger.llf - smaller.llf), 1)


def stepwise(x, y):
    selected = []
    while True:
        rest = [i for i in range(x.shape[1]) if i not in selected]
        tries = {i: fitted(x, y, sorted(selected + [i])) for i in rest}
        best = max(tries, key=lambda i: tries[i].llf, default=None)
        if best is None or p_value(fitted(x, y, selected), tries[best]) >= ENTER_P:
            return selected
        selected = sorted(selected + [best])
        while True:
            tries = {i: fitted(x, y, [j for j in selected if j != i]) for i in selected}
            worst = max(tries, key=lambda i: tries[i].llf)
            if p_value(tries[worst], fitted(x, y, selected)) <= LEAVE_P:
                break
            selected.remove(worst)


def ridge(x, y, penalty):
    """By a root of the gradient, without Newton's method on the likelihood."""
    x = sm.add_constant(x)
    keep = np.r_[0.0, np.ones(x.shape[1] - 1)]

    def gradient(beta):
        return x.T @ (y - 1 / (1 + np.exp(-x @ beta))) - penalty * keep * beta

    return optimize.root(gradient, np.zeros(x.shape[1]), tol=1e-13).x


def fit_row(kind, x, y, selected):
    fit = fitted(x, y, selected)
    return ",".join((kind, numbers(fit.params), numbers(fit.bse), numbers(fit.llf),
                     numbers(selected) if selected else ""))


def logistic_rows():
    for n, beta in ((60, (1.5, 0.0, -1.0)), (300, (0.8, 0.8, 0.0, 0.05, -0.6)), (80, (0.0, 0.0))):
        x = np.round(random.normal(0, 1, (n, len(beta))), 3)
        if len(beta) == 5:
            x[:, 2] = np.round(x[:, 0] + x[:, 1] + random.normal(0, 0.3, n), 3)  # nearly collinear
        y = (random.uniform(0, 1, n) < 1 / (1 + np.exp(-(x @ beta - 0.4)))).astype(float)
        for row, label in zip(x, y):
            yield f"example,{numbers(label)},{numbers(row)}"
        yield fit_row("fit", x, y, list(range(len(beta))))
        yield fit_row("fit", x, y, [0])
        yield fit_row("stepwise", x, y, stepwise(x, y))
        yield f"ridge,{numbers(ridge(x, y, 3.0))},3.0"


here = Path(__file__)
here.with_name("roc.csv").write_text("\n".join(roc_rows()) + "\n")
here.with_name("logistic.csv").write_text("\n".join(logistic_rows()) + "\n")
