# Reference values of autocorrelation statistics, by R's acf. Run in this folder:
# Rscript make_dependence.R. The sequence is computable anywhere:
# x_t = phi x_(t-1) + sin(t^2), x_0 = 0.
sequence <- function(phi, n) as.numeric(stats::filter(sin((1:n)^2), phi, method = "recursive"))

geyer <- function(x) {
  n <- length(x)
  rho <- acf(x, lag.max = n - 1, plot = FALSE)$acf[, 1, 1]
  pairs <- rho[seq(1, 2 * (n %/% 2), 2)] + rho[seq(2, 2 * (n %/% 2), 2)]
  stop <- which(pairs <= 0)
  if (length(stop) > 0) pairs <- pairs[seq_len(stop[1] - 1)]
  min(n / max(2 * sum(cummin(pairs)) - 1, 1 / n), n * log10(n))
}

batch <- function(x, b) {
  k <- length(x) %/% b
  b * var(colMeans(matrix(x[1:(k * b)], b)))
}

sink("dependence.csv")
cat("# Rscript tests/tables/make_dependence.R\n")
cat("phi,n,r1,r5,ess,batch\n")
for (phi in c(-0.7, 0, 0.3, 0.9)) for (n in c(50, 333, 2000)) {
  x <- sequence(phi, n)
  r <- acf(x, plot = FALSE, lag.max = 5)$acf[, 1, 1]
  b <- floor(sqrt(n))
  cat(sprintf("%.17g", c(phi, n, r[2], r[6], geyer(x), batch(x, b))), sep = ",")
  cat("\n")
}
sink()
