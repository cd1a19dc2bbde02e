% One iteration of Gustafson-Kessel clustering in matrices, as a user of Octave writes it:
%   octave-cli --no-gui gustafson_kessel.m ROWS COLUMNS CLUSTERS SECONDS     prints seconds of an iteration
% Source: gustafson1979.
1;

function u = iterate(x, u, fuzziness)
  [rows, columns] = size(x);
  clusters = size(u, 2);
  weight = u .^ fuzziness;
  squared = zeros(rows, clusters);
  for i = 1:clusters
    w = weight(:, i);
    e = x - (w' * x) / sum(w);
    covariance = (e' * (w .* e)) / sum(w);
    norm_matrix = det(covariance) ^ (1 / columns) * inv(covariance);
    squared(:, i) = sum((e * norm_matrix) .* e, 2);
  end
  nearness = max(squared, realmin) .^ (-1 / (fuzziness - 1));
  u = nearness ./ sum(nearness, 2);
end

arguments = cellfun(@str2double, argv());
randn("seed", 1);
rand("seed", 1);
x = randn(arguments(1), arguments(2));
u = rand(arguments(1), arguments(3));
u = u ./ sum(u, 2);
calls = 0;
tic;
while calls == 0 || toc < arguments(4)
  u = iterate(x, u, 2);
  calls = calls + 1;
end
printf("%.6g\n", toc / calls);
