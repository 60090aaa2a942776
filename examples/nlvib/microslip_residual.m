% [R, dR, Q] = microslip_residual(X, system, H, N, analysis_type, ...)
%
% HB_residual of NLvib, with contacts of microslip among the nonlinear elements of the system: same arguments, same results. It
% takes the elements of type 'microslip' out, lets HB_residual do the rest, and adds their forces and derivatives. A contact is
%
%   struct('type', 'microslip', 'object', object, 'force_direction', w)
%
%   object            from microslip('contact', ...) or microslip('element', ...)
%   force_direction   w, n x components, for n degrees of freedom, 1 by default: the displacement of the contact is w'*q, its force
%                     on the left side of the equations w*f; a contact has one component, an element the tangential ones and
%                     the normal one, which is positive for an approach
%   offset            optional, added to the mean displacement, a value for each component: interference, or minus the unloaded
%                     position
%   rule              optional, of the quadrature: 0 (uniform samples, as NLvib's) or 1 (event-driven)
%
% N, the number of samples per period, is at least 2H+1.
function [R, dR, Q] = microslip_residual(X, system, H, N, analysis_type, varargin)
    if nargin < 5 || isempty(analysis_type)
        analysis_type = 'frf';
    end
    elements = system.nonlinear_elements;
    ours = cellfun(@(element) strcmpi(element.type, 'microslip'), elements);
    others = struct('M', system.M, 'D', system.D, 'K', system.K, 'Fex1', system.Fex1);
    others.nonlinear_elements = elements(~ours);
    [R, dR, Q] = HB_residual(X, others, H, N, analysis_type, varargin{:});

    % Modal analysis: the displacements are the amplitude times X, and the equations are over the amplitude and their scale.
    modal = any(strcmpi(analysis_type, {'nma', 'nonlinear modal analysis'}));
    amplitude = 1;
    scale = 1;
    if modal
        amplitude = 10^X(end);
        if numel(varargin) > 1 && ~isempty(varargin{2})
            scale = varargin{2};
        end
    end

    % X has the mean of all degrees of freedom, their cosines, sines, ... of each harmonic.
    n = size(system.M, 1);
    m = n*(2*H + 1);
    coefficients = amplitude*reshape(X(1:m), n, 2*H + 1).';
    F = zeros(m, 1);
    dF = zeros(m, m);
    for k = find(ours(:).')
        [f, df, w] = contact_force(elements{k}, coefficients, N);
        F = F + f;
        for i = 1:size(w, 2)
            for j = 1:size(w, 2)
                block = df((i-1)*(2*H+1) + (1:2*H+1), (j-1)*(2*H+1) + (1:2*H+1));
                dF = dF + kron(block, w(:,i)*w(:,j).');
            end
        end
    end
    R(1:m) = R(1:m) + F/(scale*amplitude);
    dR(1:m,1:m) = dR(1:m,1:m) + dF/scale;
    if modal
        dR(1:m,end) = dR(1:m,end) + log(10)*(dF*X(1:m) - F/amplitude)/scale;
    end
end

% The forces on all degrees of freedom, in the order of X; the Jacobian of the contact itself.
function [F, jacobian, w] = contact_force(element, coefficients, N)
    w = 1;
    if isfield(element, 'force_direction')
        w = element.force_direction;
    end
    displacement = coefficients*w;
    if isfield(element, 'offset')
        displacement(1,:) = displacement(1,:) + element.offset(:).';
    end
    rule = 0;
    if isfield(element, 'rule')
        rule = element.rule;
    end
    periods = 0;
    if isfield(element, 'periods')
        periods = element.periods;
    end
    [force, jacobian] = microslip('harmonic_force', element.object, N, displacement, rule, periods);
    F = reshape(w*force.', [], 1);
end
